#include <gonio/tools/stability/inputs.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include <gonio/brdf/proof/random.h>

namespace gonio {
namespace {

using Function = std::function<double(double phi, double r)>;

double range(Azimuth azimuth) { return azimuth == Azimuth::half ? pi<double> : 2 * pi<double>; }

std::vector<double> even(double last, std::size_t lines) {
  std::vector<double> x(lines);
  for (std::size_t k = 0; k < lines; ++k)
    x[k] = last * static_cast<double>(k) / static_cast<double>(lines - 1);
  return x;
}

/// Parallels at equal steps of theta, as diagrams are measured.
std::vector<double> parallels(std::size_t lines) {
  std::vector<double> r = even(pi<double> / 2, lines);
  for (double& x : r) x = theta_to_radius(x);
  r.back() = 1;
  return r;
}

DiagramGrid tabulate(Azimuth azimuth, std::vector<double> phi, std::vector<double> r, const Function& density) {
  DiagramGrid grid{azimuth, std::move(phi), std::move(r), {}};
  for (const double p : grid.phi)
    for (const double x : grid.r) grid.density.push_back(density(p, x));
  if (azimuth == Azimuth::full)
    for (std::size_t j = 0; j < grid.r.size(); ++j) grid.at(grid.phi.size() - 1, j) = grid.at(0, j);
  return grid;
}

DiagramGrid tabulate(const Function& density) {
  return tabulate(Azimuth::half, even(pi<double>, 9), parallels(10), density);
}

DiagramGrid noise(Azimuth azimuth, std::uint32_t seed, double decades = 1) {
  proof::Random random(seed);
  const std::size_t meridians = azimuth == Azimuth::half ? 9 : 17;
  return tabulate(azimuth, even(range(azimuth), meridians), parallels(10),
                  [&](double, double) { return std::pow(10.0, -decades * static_cast<double>(random())); });
}

/// A Gaussian in r and phi (the nearer way round) over a base.
Function lobe(double phi0, double r0, double width_phi, double width_r, double base) {
  return [=](double phi, double r) {
    const double a = std::remainder(phi - phi0, 2 * pi<double>) / width_phi, b = (r - r0) / width_r;
    return base + std::exp(-(a * a + b * b) / 2);
  };
}

/// The diagram seen in a mirror: phi becomes range - phi.
DiagramGrid mirrored(const DiagramGrid& grid) {
  DiagramGrid result = grid;
  const std::size_t m = grid.phi.size();
  for (std::size_t i = 0; i < m; ++i) {
    result.phi[i] = range(grid.azimuth) - grid.phi[m - 1 - i];
    for (std::size_t j = 0; j < grid.r.size(); ++j) result.at(i, j) = grid.at(m - 1 - i, j);
  }
  return result;
}

DiagramGrid edited(DiagramGrid grid, const std::function<void(DiagramGrid&)>& edit) {
  edit(grid);
  return grid;
}

}  // namespace

std::vector<StabilityInput> stability_inputs() {
  const Azimuth half = Azimuth::half, full = Azimuth::full;
  std::vector<StabilityInput> inputs;
  const auto add = [&](const char* name, const char* reason, const DiagramGrid& first) {
    inputs.push_back({name, reason, first, mirrored(first)});
  };

  add("constant", "equal densities: the cubic and the quadratic lose their leading term",
      tabulate([](double, double) { return 1.0; }));
  {
    proof::Random random(1);
    add("nearly-constant", "densities that differ in the sixth digit: the leading term is all rounding",
        tabulate([&](double, double) { return 1 + 2e-6 * static_cast<double>(random()); }));
  }
  add("ramp-phi", "linear in phi from 0: a meridian without mass at one end, closed form",
      tabulate([](double phi, double) { return phi; }));
  add("ramp-r", "linear in r from 0 at the pole, closed form", tabulate([](double, double r) { return r; }));

  const DiagramGrid base = noise(half, 2);
  const std::size_t m = base.phi.size(), n = base.r.size();
  add("zero-corner", "one density of a patch is 0", edited(base, [](DiagramGrid& g) { g.at(3, 4) = 0; }));
  add("zero-edge", "the horizon has no density: cosines vanish there",
      edited(base, [&](DiagramGrid& g) { for (std::size_t i = 0; i < m; ++i) g.at(i, n - 1) = 0; }));
  add("zero-patch", "a patch without density (Fig. 6d): the map must jump over it", edited(base, [](DiagramGrid& g) {
        for (std::size_t i = 3; i < 5; ++i)
          for (std::size_t j = 4; j < 6; ++j) g.at(i, j) = 0;
      }));
  add("zero-meridian", "a meridian without mass: the conditional is 0/0 there",
      edited(base, [&](DiagramGrid& g) { for (std::size_t j = 0; j < n; ++j) g.at(3, j) = 0; }));
  add("zero-parallel", "a parallel without density between two with it",
      edited(base, [&](DiagramGrid& g) { for (std::size_t i = 0; i < m; ++i) g.at(i, 4) = 0; }));
  add("one-cell-spike", "one density 1e5 times its neighbours: a mirror in a coarse table",
      tabulate([&](double phi, double r) { return phi == base.phi[5] && r == base.r[3] ? 1e5 : 1.0; }));
  add("twelve-decades", "densities from 1 to 1e-12: metals at grazing angles", noise(half, 3, 12));
  inputs.push_back({"two-lines", "pole and horizon only, 1 and 0: the worst case of M_E in the paper",
                    tabulate(half, {0, pi<double>}, {0, 1}, [](double, double r) { return 1 - r; }),
                    tabulate(half, {0, pi<double>}, {0, 1}, [](double phi, double r) { return 1 - r + phi * r; })});
  {
    proof::Random random(4);
    const double e = 2e-6;  // some 30 floats
    const std::vector<double> phi{0, 0.5, 0.5 + e, 1.7, 1.7 + 20 * e, 3, pi<double>};
    const std::vector<double> r{0, 0.1, 0.1 + e, 0.4, 0.4 + 10 * e, 0.7, 0.7 + e, 0.95, 1};
    add("coincident-lines", "irregular lines, some closer than 1e-5: cells of almost no area",
        tabulate(half, phi, r, [&](double, double) { return 0.1 + static_cast<double>(random()); }));
  }
  const std::vector<double> near_pole{0,    2e-4, 4e-4, 5e-4, 6e-4, 8e-4, 2e-3, 0.1, 0.4, 0.7, 1};
  add("pole-ring", "a narrow lobe at normal incidence, 0.04 degrees about the pole",
      tabulate(half, even(pi<double>, 9), near_pole, lobe(0, 5e-4, 1e9, 8e-5, 1e-7)));
  inputs.push_back({"seam-lobe", "a lobe over phi = 0 of a full diagram",
                    tabulate(full, even(2 * pi<double>, 33), parallels(17), lobe(0, 0.5, 0.3, 0.08, 0.02)),
                    tabulate(full, even(2 * pi<double>, 33), parallels(17), lobe(0.6, 0.6, 0.3, 0.08, 0.02))});
  inputs.push_back({"horizon-lobe", "a forward lobe cut by the horizon: grazing incidence",
                    tabulate(half, even(pi<double>, 33), parallels(33), lobe(pi<double>, 0.9, 0.3, 0.04, 0.02)),
                    tabulate(half, even(pi<double>, 33), parallels(33), lobe(pi<double>, 1.0, 0.2, 0.04, 0.02))});
  inputs.push_back({"rotating-lobe", "the lobe turns by 140 degrees between two diagrams: the worst case of displacement",
                    tabulate(half, even(pi<double>, 33), parallels(17), lobe(0.4, 0.5, 0.2, 0.08, 0.01)),
                    tabulate(half, even(pi<double>, 33), parallels(17), lobe(2.84, 0.5, 0.2, 0.08, 0.01))});
  inputs.push_back({"noise", "no structure at all, three decades, full azimuth", noise(full, 5, 3), noise(full, 6, 3)});
  return inputs;
}

}  // namespace gonio
