#include <algorithm>
#include <cmath>
#include <string>

#include <gonio/brdf/proof/statistics/bins.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio::proof {
namespace {

// Gauss-Lobatto on [0, 1] with 5 points, and Simpson's rule on three of them (Abramowitz and Stegun, 25.4.32
// and 25.4.5). Both have the ends: the foot of a peak beside the cell is seen from within it.
constexpr int points = 5;
constexpr double node[points] = {0, 0.172673164646011, 0.5, 0.827326835353989, 1};
constexpr double lobatto[points] = {1.0 / 20, 49.0 / 180, 16.0 / 45, 49.0 / 180, 1.0 / 20};
constexpr double simpson[points] = {1.0 / 6, 0, 4.0 / 6, 0, 1.0 / 6};

/// The radius from the nearer pole: r beyond the equator runs from 1 to 2.
double from_pole(double r) { return r > 1 ? 2 - r : r; }

glm::vec3 direction(double phi, double r) {
  // The horizon itself is no direction of reflection: seen from beside it.
  glm::dvec3 w = polar_to_direction(Polar<double>{std::min(from_pole(r), 1 - 1e-7), phi});
  if (r > 1) w.z = -w.z;
  return glm::vec3(w);
}

/// The share of solid angle up to r, in units of the hemisphere.
double area_to(double r) { return r > 1 ? 2 - (2 - r) * (2 - r) : r * r; }

double end_of(Domain domain) { return domain == Domain::sphere ? 2 : 1; }

double magnitude(double x) { return std::abs(x); }
double magnitude(const glm::dvec3& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); }

struct Cell {
  double phi0, phi1, r0, r1;
};

/// How far a part of a cell, a `share` of its error, may be off where the function integrates to about 1: some
/// thousand cells of this error, of either sign, stay below 1e-4. For that many draws to be told from the
/// sum, no more than a twentieth of their standard deviation either, or a fifth of a draw.
double tolerance(double value, double share, double draws) {
  constexpr double largest = 2e-6;
  if (draws == 0) return largest * share;
  return std::min(largest * share, std::max(std::sqrt(value / draws) / 20, share / (5 * draws)));
}

/// Lobatto's rule where Simpson's says nearly the same, else the sum over the quarters.
template <class Value, class Function>
Value adaptive(const Cell& c, const Function& function, double draws, double share = 1, int depth = 0) {
  constexpr int largest_depth = 9;
  Value fine(0), coarse(0);
  for (int a = 0; a < points; ++a) {
    const double r = c.r0 + node[a] * (c.r1 - c.r0);
    const double ring = 2 * from_pole(r) * (c.r1 - c.r0) * (c.phi1 - c.phi0);
    for (int b = 0; b < points; ++b) {
      const Value value = ring * Value(function(direction(c.phi0 + node[b] * (c.phi1 - c.phi0), r)));
      fine += lobatto[a] * lobatto[b] * value;
      coarse += simpson[a] * simpson[b] * value;
    }
  }
  if (depth == largest_depth || magnitude(fine - coarse) <= tolerance(magnitude(fine), share, draws)) return fine;
  const double phi = (c.phi0 + c.phi1) / 2, r = (c.r0 + c.r1) / 2;
  Value sum(0);
  for (const Cell& quarter :
       {Cell{c.phi0, phi, c.r0, r}, {phi, c.phi1, c.r0, r}, {c.phi0, phi, r, c.r1}, {phi, c.phi1, r, c.r1}})
    sum += adaptive<Value>(quarter, function, draws, share / 2, depth + 1);
  return sum;
}

/// What decides where edges are wanted, per cell of an axis.
struct Profile {
  std::vector<double> area, mass, variation;
};

/// Edges at the quantiles of the mean of the profile's distributions over the cells of `x`.
std::vector<double> spread(const std::vector<double>& x, const Profile& profile, std::size_t cells) {
  std::vector<double> cumulative(x.size(), 0.0);
  for (const auto* share : {&profile.area, &profile.mass, &profile.variation}) {
    double total = 0, sum = 0;
    for (const double s : *share) total += s;
    for (std::size_t k = 0; total > 0 && k + 1 < x.size(); ++k) {
      sum += (*share)[k];
      cumulative[k + 1] += sum / total;
    }
  }
  std::vector<double> edges{x.front()};
  std::size_t k = 0;
  for (std::size_t n = 1; n < cells; ++n) {
    const double target = cumulative.back() * static_cast<double>(n) / static_cast<double>(cells);
    while (cumulative[k + 1] < target) ++k;
    edges.push_back(x[k] + (target - cumulative[k]) / (cumulative[k + 1] - cumulative[k]) * (x[k + 1] - x[k]));
  }
  edges.push_back(x.back());
  return edges;
}

void check(const std::vector<double>& edges, double first, double last, const char* name) {
  bool good = edges.size() >= 2 && std::abs(edges.front() - first) < 1e-9 && std::abs(edges.back() - last) < 1e-9;
  for (std::size_t k = 1; k < edges.size(); ++k) good = good && edges[k] > edges[k - 1];
  if (!good)
    throw Error(std::string("bins: ") + name + ": found edges that do not ascend over the range, expected " +
                std::to_string(first) + " to " + std::to_string(last));
}

}  // namespace

Bins::Bins(std::vector<double> phi, std::vector<double> r, Domain domain)
    : phi_(std::move(phi)), r_(std::move(r)), domain_(domain) {
  check(phi_, -pi<double>, pi<double>, "phi");
  check(r_, 0, end_of(domain), "r");
}

Bins Bins::adapted(const Density& density, int n_phi, int n_r, Domain domain) {
  const auto uniform = [](double first, double last, std::size_t cells) {
    std::vector<double> x(cells + 1);
    for (std::size_t k = 0; k <= cells; ++k)
      x[k] = first + (last - first) * static_cast<double>(k) / static_cast<double>(cells);
    return x;
  };
  std::vector<double> phi = uniform(-pi<double>, pi<double>, 95), r = uniform(0, end_of(domain), 127);
  for (int round = 0; round < 3; ++round) {
    const std::size_t m = phi.size() - 1, n = r.size() - 1;
    Profile across{std::vector<double>(m), std::vector<double>(m, 0.0), std::vector<double>(m, 0.0)};
    Profile along{std::vector<double>(n), std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
    for (std::size_t i = 0; i < m; ++i) across.area[i] = phi[i + 1] - phi[i];
    for (std::size_t j = 0; j < n; ++j) along.area[j] = area_to(r[j + 1]) - area_to(r[j]);
    std::vector<double> value(m * n);
    for (std::size_t i = 0; i < m; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const double d = density(direction((phi[i] + phi[i + 1]) / 2, (r[j] + r[j + 1]) / 2));
        value[i * n + j] = std::isfinite(d) && d > 0 ? d : 0;
        const double mass = value[i * n + j] * across.area[i] * along.area[j];
        across.mass[i] += mass;
        along.mass[j] += mass;
        // The variation of the density is all in its peaks, however little mass they have.
        const auto vary = [&](Profile& p, std::size_t k, std::size_t other, double width) {
          const double change = std::abs(value[i * n + j] - value[other]) * width;
          p.variation[k] += change;
          p.variation[k - 1] += change;
        };
        if (i > 0) vary(across, i, (i - 1) * n + j, along.area[j]);
        if (j > 0) vary(along, j, i * n + j - 1, across.area[i]);
      }
    }
    const bool last = round == 2;
    std::vector<double> next_phi = spread(phi, across, last ? static_cast<std::size_t>(n_phi) : m);
    r = spread(r, along, last ? static_cast<std::size_t>(n_r) : n);
    phi = std::move(next_phi);
  }
  return Bins(std::move(phi), std::move(r), domain);
}

std::size_t Bins::index(const glm::vec3& w) const noexcept {
  const bool below = w.z < 0;
  if (std::isnan(w.z) || (below && domain_ == Domain::hemisphere)) return size();
  Polar<float> p = direction_to_polar(glm::vec3(w.x, w.y, std::abs(w.z)));  // w has no more digits
  if (below) p.r = 2 - p.r;
  const auto cell = [](const std::vector<double>& edges, double x) {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, x);
    return static_cast<std::size_t>(above - edges.begin()) - 1;
  };
  return cell(phi_, p.phi) * (r_.size() - 1) + cell(r_, p.r);
}

std::vector<double> Bins::integrate(const Density& density, std::uint64_t draws) const {
  std::vector<double> result;
  result.reserve(size());
  for (std::size_t i = 0; i + 1 < phi_.size(); ++i)
    for (std::size_t j = 0; j + 1 < r_.size(); ++j)
      result.push_back(adaptive<double>({phi_[i], phi_[i + 1], r_[j], r_[j + 1]}, density, static_cast<double>(draws)));
  return result;
}

glm::dvec3 Bins::integrate_rgb(const std::function<glm::vec3(const glm::vec3&)>& function) const {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i + 1 < phi_.size(); ++i)
    for (std::size_t j = 0; j + 1 < r_.size(); ++j)
      sum += adaptive<glm::dvec3>({phi_[i], phi_[i + 1], r_[j], r_[j + 1]}, function, 0);
  return sum;
}

}  // namespace gonio::proof
