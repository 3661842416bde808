#include <algorithm>

#include <gonio/brdf/build/stack/diagram_recipe.h>
#include <gonio/brdf/build/stack/raise_tail.h>

namespace gonio::detail {
namespace {

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

}  // namespace

LineFit prepare_lines(const BrdfTable& table, Chart chart, int most_meridians, int most_parallels,
                      const std::vector<double>& more) {
  constexpr int angles = 14;
  std::vector<DiskDensity> densities;
  densities.reserve(angles + more.size() + 1);
  for (int k = 0; k < angles; ++k)
    densities.push_back(table_density(table, chart, pi<double> / 2 * (k + 0.5) / angles));
  for (const double theta_i : more) densities.push_back(table_density(table, chart, theta_i));
  densities.push_back(cosine_density(chart, 0));  // lines for a black table, and for the floor
  return LineFit(densities, Azimuth::half, most_meridians, most_parallels);
}

DiskDensity Recipe::density_at(double theta_i) const { return table_density(table_, chart_, theta_i); }

DiagramGrid Recipe::diagram(double theta_i) const {
  const DiskDensity cosine = cosine_density(chart_, theta_i);
  DiagramGrid grid = fitted(density_at(theta_i));
  if (std::all_of(grid.density.begin(), grid.density.end(), [](double d) { return d == 0; })) return fitted(cosine);
  if (can_be_raised(theta_i))
    raise(theta_i, 1, grid);
  else
    grid = Diagram<double>(grid).grid();
  for (std::size_t i = 0; i < grid.phi.size(); ++i)
    for (std::size_t j = 0; j < grid.r.size(); ++j)
      grid.at(i, j) = (1 - cosine_share) * grid.at(i, j) + cosine_share * cosine({grid.r[j], grid.phi[i]});
  return grid;
}

bool Recipe::can_be_raised(double theta_i) const {
  return chart_ == Chart::outgoing || theta_i < 89 * pi<double> / 180;
}

void Recipe::raise(double theta_i, double mean, DiagramGrid& grid) const {
  raise_tail([density = density_at(theta_i), mean](Polar<double> at) { return density(at) / mean; }, grid);
  grid = Diagram<double>(grid).grid();
}

DiagramGrid Recipe::fitted(const DiskDensity& density) const {
  return shared_ ? fit_diagram(density, *shared_) : fit_diagram(density, Azimuth::half, limits_);
}

}  // namespace gonio::detail
