#include <gonio/brdf/build.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <string>

#include <gonio/brdf/parallel.h>
#include <gonio/mapping/error.h>
#include <gonio/mapping/fit.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;
// Beyond this, tables hold extrapolated values at best; the last diagram serves the rest.
constexpr double largest_angle = 89.5 * degree;
constexpr double smallest_gap = 0.1 * degree;

DiagramGrid build_diagram(const BrdfTable& table, double theta_i, const StackOptions& options) {
  DiagramGrid grid = fit_diagram(
      [&](Polar<double> at) { return transfer_density(table, theta_i, at); }, Azimuth::half,
      {options.meridians, options.parallels, options.tolerance / 2});
  const bool black = std::all_of(grid.density.begin(), grid.density.end(), [](double d) { return d == 0; });
  if (!black) grid = Diagram<double>(grid).grid();
  const double share = black ? 1 : cosine_share;
  for (std::size_t i = 0; i < grid.phi.size(); ++i)
    for (std::size_t j = 0; j < grid.r.size(); ++j)
      grid.at(i, j) = (1 - share) * grid.at(i, j) + share * (1 - grid.r[j] * grid.r[j]) / pi<double>;
  return grid;
}

struct Built {
  DiagramGrid grid;
  Diagram<double> diagram;

  /// What the diagram will take when it is sampled, in float.
  std::size_t bytes() const { return diagram.bytes() / 2; }
};

/// Relative variance of sampling the table at theta_i with the displacement of two diagrams.
double interpolation_relvar(const BrdfTable& table, double theta_i, const Built& a, const Built& b, double alpha) {
  constexpr int side = 64;
  const Displacement<double> map(a.diagram, b.diagram, alpha);
  double sum = 0, sum2 = 0;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      // A fixed lattice inside the cells, so that no row or column of samples shares a coordinate.
      const double jitter = (x * 19 + y * 27) % side + 0.5;
      const auto s = map.sample((x + jitter / side) / side, (y + (side - jitter) / side) / side);
      const double weight = s.pdf > 0 ? transfer_density(table, theta_i, s.at) / s.pdf : 0;
      sum += weight;
      sum2 += weight * weight;
    }
  }
  return sum > 0 ? std::max(0.0, sum2 * side * side / (sum * sum) - 1) : 0;
}

}  // namespace

double transfer_density(const BrdfTable& table, double theta_i, Polar<double> at) {
  const glm::vec3 wi(static_cast<float>(std::sin(theta_i)), 0, static_cast<float>(std::cos(theta_i)));
  const glm::vec3 wo(polar_to_direction(at));
  const double left = luminance(table.eval(wi, wo));
  const double right = luminance(table.eval(wi, {wo.x, -wo.y, wo.z}));
  return (left + right) / 2 * wo.z;
}

StackGrid build_stack(const BrdfTable& table, const StackOptions& options, const Progress& progress) {
  if (options.incident < 2)
    throw Error("stack: incident: found " + std::to_string(options.incident) + ", expected at least 2");
  const std::size_t limit = static_cast<std::size_t>(options.incident);

  std::mutex mutex;
  std::map<double, Built> built;
  const auto build_all = [&](const std::vector<double>& angles) {
    parallel_for(angles.size(), [&](std::size_t k) {
      DiagramGrid grid = build_diagram(table, angles[k], options);
      Diagram<double> diagram(grid);
      const std::lock_guard<std::mutex> lock(mutex);
      built.emplace(angles[k], Built{std::move(grid), std::move(diagram)});
      if (progress) progress(std::min(1.0, static_cast<double>(built.size()) / static_cast<double>(limit)));
    });
  };
  std::vector<double> start;
  const std::size_t first = std::min<std::size_t>(limit, 7);
  for (std::size_t k = 0; k < first; ++k)
    start.push_back(largest_angle * static_cast<double>(k) / static_cast<double>(first - 1));
  build_all(start);

  // Split the intervals with the largest error, a fixed few at a time: the outcome is the same
  // however many threads share the work.
  constexpr std::size_t batch = 4;
  std::map<double, double> error;  // by the lower end of each interval
  const auto bytes = [&] {
    std::size_t sum = 0;
    for (const auto& [angle, entry] : built) sum += entry.bytes();
    return sum;
  };
  while (built.size() < limit && bytes() < options.bytes) {
    std::vector<double> lower, unknown;
    for (auto it = built.begin(); std::next(it) != built.end(); ++it)
      if (!error.count(it->first)) unknown.push_back(it->first);
    std::vector<double> estimate(unknown.size());
    parallel_for(unknown.size(), [&](std::size_t k) {
      const auto a = built.find(unknown[k]);
      const auto b = std::next(a);
      estimate[k] = b->first - a->first < 2 * smallest_gap
                        ? 0
                        : interpolation_relvar(table, (a->first + b->first) / 2, a->second, b->second, 0.5);
    });
    for (std::size_t k = 0; k < unknown.size(); ++k) error[unknown[k]] = estimate[k];

    std::vector<std::pair<double, double>> order;  // (-error, lower end)
    for (const auto& [angle, value] : error)
      if (value > options.tolerance) order.emplace_back(-value, angle);
    std::sort(order.begin(), order.end());
    order.resize(std::min({order.size(), batch, limit - built.size()}));
    if (order.empty()) break;
    std::vector<double> middles;
    for (const auto& [value, angle] : order) {
      middles.push_back((angle + std::next(built.find(angle))->first) / 2);
      error.erase(angle);
    }
    build_all(middles);
    // Where a diagram of its own is hardly better than the interpolation, more angles do not help:
    // the diagram's size or the noise of the table is the limit there.
    for (std::size_t k = 0; k < middles.size(); ++k) {
      const Built& own = built.at(middles[k]);
      const double floor = interpolation_relvar(table, middles[k], own, own, 0);
      if (floor > -order[k].first / 1.5) error[order[k].second] = error[middles[k]] = 0;
    }
  }
  if (progress) progress(1);

  StackGrid stack;
  for (auto& [angle, entry] : built) {
    stack.theta_i.push_back(angle);
    stack.diagrams.push_back(std::move(entry.grid));
  }
  return stack;
}

}  // namespace gonio
