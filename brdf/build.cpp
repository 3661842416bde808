#include <gonio/brdf/build.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include <gonio/brdf/parallel.h>
#include <gonio/mapping/error.h>
#include <gonio/mapping/diagram_fit.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;
// Beyond this, tables hold extrapolated values at best; the last diagram serves the rest.
constexpr double largest_angle = 89.5 * degree;
constexpr double smallest_gap = 0.1 * degree;

/// How the diagrams of a stack are made: the density in the chart, and the lines if they are shared.
class Recipe {
 public:
  Recipe(const BrdfTable& table, const StackOptions& options)
      : table_(table), chart_(options.chart), limits_{options.meridians, options.parallels, options.tolerance / 2} {
    if (options.interpolation != Interpolation::blend) return;
    constexpr int angles = 14;
    std::vector<DiskDensity> densities;
    for (int k = 0; k < angles; ++k) densities.push_back(density_at(pi<double> / 2 * (k + 0.5) / angles));
    densities.push_back(cosine_at(0));  // lines for a black table, and for the floor
    // The worst of the angles decides: it may have what the interpolation is allowed altogether.
    shared_ = fit_lines(densities, Azimuth::half, {options.meridians, options.parallels, options.tolerance});
  }

  DiskDensity density_at(double theta_i) const {
    return [this, theta_i](Polar<double> at) { return disk_density(table_, chart_, theta_i, at); };
  }

  DiagramGrid diagram(double theta_i) const {
    const DiskDensity cosine = cosine_at(theta_i);
    DiagramGrid grid = fitted(density_at(theta_i));
    if (std::all_of(grid.density.begin(), grid.density.end(), [](double d) { return d == 0; })) return fitted(cosine);
    grid = Diagram<double>(grid).grid();
    for (std::size_t i = 0; i < grid.phi.size(); ++i)
      for (std::size_t j = 0; j < grid.r.size(); ++j)
        grid.at(i, j) = (1 - cosine_share) * grid.at(i, j) + cosine_share * cosine({grid.r[j], grid.phi[i]});
    return grid;
  }

 private:
  DiskDensity cosine_at(double theta_i) const {
    if (chart_ == Chart::outgoing) return [](Polar<double> at) { return (1 - at.r * at.r) / pi<double>; };
    return [chart = HalfVectorChart<double>(theta_i)](Polar<double> at) {
      const auto d = chart.direction(at);
      return d.wo.z / pi<double> * d.jacobian;
    };
  }
  DiagramGrid fitted(const DiskDensity& density) const {
    return shared_ ? fit_diagram(density, *shared_) : fit_diagram(density, Azimuth::half, limits_);
  }

  const BrdfTable& table_;
  Chart chart_;
  FitLimits limits_;
  std::optional<SharedLines> shared_;
};

struct Built {
  DiagramGrid grid;
  Diagram<double> diagram;

  /// What the diagram will take when it is sampled, in float.
  std::size_t bytes() const { return diagram.bytes() / 2; }
};

/// Relative variance of sampling a density by a map of the square to the disk.
template <class Map>
double map_relvar(const DiskDensity& density, const Map& map) {
  constexpr int side = 64;
  double sum = 0, sum2 = 0;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      // A fixed lattice inside the cells, so that no row or column of samples shares a coordinate.
      const double jitter = (x * 19 + y * 27) % side + 0.5;
      const auto s = map.sample((x + jitter / side) / side, (y + (side - jitter) / side) / side);
      const double weight = s.pdf > 0 ? density(s.at) / s.pdf : 0;
      sum += weight;
      sum2 += weight * weight;
    }
  }
  return sum > 0 ? std::max(0.0, sum2 * side * side / (sum * sum) - 1) : 0;
}

/// Diagrams by incident angle, grown until nothing fails or a limit is met.
class Growth {
 public:
  Growth(const BrdfTable& table, const StackOptions& options, const Progress& progress)
      : recipe_(table, options), options_(options), progress_(progress) {
    constexpr std::size_t first = 7;
    std::vector<double> start;
    const std::size_t count = std::min(limit(), first);
    for (std::size_t k = 0; k < count; ++k)
      start.push_back(largest_angle * static_cast<double>(k) / static_cast<double>(count - 1));
    build(start);
    while (split_worst()) {
    }
    estimate_errors();
  }

  bool out_of_bytes() const { return out_of_bytes_; }

  /// The mean over the angles of the estimates of relvar. (The worst would say little: it is often
  /// that of an angle where the table is noise and no stack does better.)
  double mean_error() const {
    double sum = 0;
    for (const auto& [angle, error] : error_) sum += error * (std::next(built_.find(angle))->first - angle);
    return sum / (built_.rbegin()->first - built_.begin()->first);
  }

  StackGrid take() {
    StackGrid stack;
    stack.chart = options_.chart;
    for (auto& [angle, entry] : built_) {
      stack.theta_i.push_back(angle);
      stack.diagrams.push_back(std::move(entry.grid));
    }
    return stack;
  }

 private:
  std::size_t limit() const { return static_cast<std::size_t>(options_.incident); }

  void build(const std::vector<double>& angles) {
    parallel_for(angles.size(), [&](std::size_t k) {
      DiagramGrid grid = recipe_.diagram(angles[k]);
      Diagram<double> diagram(grid);
      const std::lock_guard<std::mutex> lock(mutex_);
      bytes_ += built_.emplace(angles[k], Built{std::move(grid), std::move(diagram)}).first->second.bytes();
      if (progress_)
        progress_(std::min(1.0, std::max(static_cast<double>(built_.size()) / static_cast<double>(limit()),
                                         static_cast<double>(bytes_) / static_cast<double>(options_.bytes))));
    });
  }

  double relvar(double theta_i, const Built& a, const Built& b, double alpha) const {
    const DiskDensity density = recipe_.density_at(theta_i);
    if (options_.interpolation == Interpolation::blend)
      return map_relvar(density, Blend<double>(a.diagram, b.diagram, alpha));
    return map_relvar(density, Displacement<double>(a.diagram, b.diagram, alpha));
  }

  void estimate_errors() {
    std::vector<double> unknown;
    for (auto it = built_.begin(); std::next(it) != built_.end(); ++it)
      if (!error_.count(it->first)) unknown.push_back(it->first);
    constexpr double probes[] = {0.25, 0.5, 0.75};
    constexpr std::size_t count = std::size(probes);
    std::vector<double> estimate(unknown.size() * count, 0.0);
    parallel_for(estimate.size(), [&](std::size_t k) {
      const auto a = built_.find(unknown[k / count]);
      const auto b = std::next(a);
      const double alpha = probes[k % count];
      estimate[k] = relvar((1 - alpha) * a->first + alpha * b->first, a->second, b->second, alpha);
    });
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const auto worst = std::max_element(estimate.begin() + k * count, estimate.begin() + (k + 1) * count);
      error_[unknown[k]] = *worst;
    }
  }

  /// Splits the intervals with the largest error, a fixed few at a time, so that the outcome is the
  /// same however many threads share the work. False when nothing is left to split or a limit is met.
  bool split_worst() {
    constexpr std::size_t batch = 4;
    estimate_errors();
    std::vector<std::pair<double, double>> order;  // (-error, lower end)
    for (const auto& [angle, error] : error_) {
      const bool wide = std::next(built_.find(angle))->first - angle > 2 * smallest_gap;
      if (error > options_.tolerance && wide && !settled_.count(angle)) order.emplace_back(-error, angle);
    }
    std::sort(order.begin(), order.end());
    order.resize(std::min({order.size(), batch, limit() - built_.size()}));
    if (order.empty()) return false;

    std::vector<double> middles;
    for (const auto& [error, angle] : order)
      middles.push_back((angle + std::next(built_.find(angle))->first) / 2);
    build(middles);
    while (bytes_ > options_.bytes && !middles.empty()) {  // what does not fit goes, the least useful first
      const auto last = built_.find(middles.back());
      bytes_ -= last->second.bytes();
      built_.erase(last);
      middles.pop_back();
      out_of_bytes_ = true;
    }
    for (std::size_t k = 0; k < middles.size(); ++k) {
      // Where a diagram of its own is hardly better than the interpolation was, more angles do not
      // help: the size of the diagram or the noise of the table is the limit there.
      const Built& own = built_.at(middles[k]);
      const double floor = relvar(middles[k], own, own, 0);
      if (floor > -order[k].first / 1.5) settled_.insert({order[k].second, middles[k]});
      error_.erase(order[k].second);
    }
    return !out_of_bytes_;
  }

  const Recipe recipe_;
  const StackOptions& options_;
  const Progress& progress_;
  std::mutex mutex_;
  std::map<double, Built> built_;
  std::map<double, double> error_;  // by the lower end of each interval
  std::set<double> settled_;        // lower ends of intervals that splitting does not improve
  std::size_t bytes_ = 0;
  bool out_of_bytes_ = false;
};

}  // namespace

double transfer_density(const BrdfTable& table, double theta_i, const Vec3<double>& wo) {
  const glm::vec3 wi(static_cast<float>(std::sin(theta_i)), 0, static_cast<float>(std::cos(theta_i)));
  const glm::vec3 w(wo);
  const double left = luminance(table.eval(wi, w));
  if (std::holds_alternative<GridTable>(table.data())) return left * wo.z;  // mirrored as it is
  const double right = luminance(table.eval(wi, {w.x, -w.y, w.z}));
  return (left + right) / 2 * wo.z;
}

double disk_density(const BrdfTable& table, Chart chart, double theta_i, Polar<double> at) {
  if (chart == Chart::outgoing) return transfer_density(table, theta_i, polar_to_direction(at));
  const auto d = HalfVectorChart<double>(theta_i).direction(at);
  return transfer_density(table, theta_i, d.wo) * d.jacobian;
}

StackGrid build_stack(const BrdfTable& table, const StackOptions& options, const Progress& progress) {
  if (options.incident < 2)
    throw Error("stack: incident: found " + std::to_string(options.incident) + ", expected at least 2");
  if (!(options.tolerance > 0))
    throw Error("stack: tolerance: found " + std::to_string(options.tolerance) + ", expected more than 0");
  // When the memory does not suffice for the tolerance, diagrams of that quality leave too few of
  // them: coarser ones at more angles may do better. The tolerance grows as long as they do.
  StackOptions attempt = options;
  std::optional<StackGrid> best;
  double best_error = std::numeric_limits<double>::infinity();
  for (bool more = true; more; attempt.tolerance *= 2) {
    Growth growth(table, attempt, progress);
    // Equal: the tolerance was out of reach of the largest diagram, and still is.
    const bool as_good = growth.mean_error() <= best_error;
    more = as_good && growth.out_of_bytes();
    if (!as_good) break;
    best_error = growth.mean_error();
    best = growth.take();
  }
  if (progress) progress(1);
  return *best;
}

}  // namespace gonio
