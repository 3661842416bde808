#include <gonio/brdf/recipe.h>

#include <algorithm>

namespace gonio::detail {
namespace {

// What raise_horizon() allows.
constexpr double horizon_weight = 1.25;

DiskDensity table_density(const BrdfTable& table, Chart chart, double theta_i) {
  return [&table, chart, theta_i](Polar<double> at) { return disk_density(table, chart, theta_i, at); };
}

DiskDensity cosine_density(Chart chart, double theta_i) {
  if (chart == Chart::outgoing) return [](Polar<double> at) { return (1 - at.r * at.r) / pi<double>; };
  return [chart = HalfVectorChart<double>(theta_i)](Polar<double> at) {
    const auto d = chart.direction(at);
    return d.wo.z / pi<double> * d.jacobian;
  };
}

/// Raises the last parallel of a fitted diagram, the horizon, so that in the last cells the weight density / diagram is
/// at most `horizon_weight` times its mean. The fit cannot see to that: hardly any mass is there, but every side of
/// the unit square is.
void raise_horizon(const DiskDensity& density, DiagramGrid& grid) {
  const std::size_t last = grid.r.size() - 1;
  const double h = 1 - grid.r[last - 1];
  std::vector<double> wanted(grid.phi.size(), 0.0);
  // `i` and the next meridian carry what is wanted between them.
  const auto look = [&](std::size_t i, double t) {
    const std::size_t next = std::min(i + 1, grid.phi.size() - 1);
    const double phi = (1 - t) * grid.phi[i] + t * grid.phi[next];
    const double start = (1 - t) * grid.at(i, last - 1) + t * grid.at(next, last - 1);
    for (double part = 0.5; part * h > least_gap<float>; part *= 0.6) {
      const double gap = part * h, g = density({1 - gap, phi, gap});
      if (!(g > 0 && std::isfinite(g))) continue;
      const double end = (g / horizon_weight - start * part) / (1 - part);
      wanted[i] = std::max(wanted[i], end), wanted[next] = std::max(wanted[next], t > 0 ? end : 0.0);
    }
  };
  for (std::size_t i = 0; i < grid.phi.size(); ++i)
    for (double t = 0; t < (i + 1 < grid.phi.size() ? 1 : 0.1); t += 0.125) look(i, t);
  for (std::size_t i = 0; i < grid.phi.size(); ++i) grid.at(i, last) = std::max(grid.at(i, last), wanted[i]);
}

}  // namespace

LineFit prepare_lines(const BrdfTable& table, Chart chart, int most_meridians, int most_parallels,
                      const std::vector<double>& more) {
  constexpr int angles = 14;
  std::vector<DiskDensity> densities;
  for (int k = 0; k < angles; ++k) densities.push_back(table_density(table, chart, pi<double> / 2 * (k + 0.5) / angles));
  for (const double theta_i : more) densities.push_back(table_density(table, chart, theta_i));
  densities.push_back(cosine_density(chart, 0));  // lines for a black table, and for the floor
  return LineFit(densities, Azimuth::half, most_meridians, most_parallels);
}

DiskDensity Recipe::density_at(double theta_i) const { return table_density(table_, chart_, theta_i); }

DiagramGrid Recipe::diagram(double theta_i) const {
  const DiskDensity cosine = cosine_density(chart_, theta_i);
  DiagramGrid grid = fitted(density_at(theta_i));
  if (std::all_of(grid.density.begin(), grid.density.end(), [](double d) { return d == 0; })) return fitted(cosine);
  raise_horizon(density_at(theta_i), grid);
  grid = Diagram<double>(grid).grid();
  for (std::size_t i = 0; i < grid.phi.size(); ++i)
    for (std::size_t j = 0; j < grid.r.size(); ++j)
      grid.at(i, j) = (1 - cosine_share) * grid.at(i, j) + cosine_share * cosine({grid.r[j], grid.phi[i]});
  return grid;
}

DiagramGrid Recipe::fitted(const DiskDensity& density) const {
  return shared_ ? fit_diagram(density, *shared_) : fit_diagram(density, Azimuth::half, limits_);
}

}  // namespace gonio::detail
