#include "tools/stability/inputs.h"

#include <cmath>
#include <functional>
#include <utility>

#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio {
namespace {

DiagramGrid tabulate(const std::vector<double>& phi, const std::vector<double>& r,
                     const std::function<double(double phi, double r)>& density) {
  DiagramGrid grid{Azimuth::half, phi, r, {}};
  for (const double p : phi)
    for (const double x : r) grid.density.push_back(density(p, x));
  return grid;
}

}  // namespace

std::vector<StabilityInput> stability_inputs() {
  std::vector<StabilityInput> inputs;
  for (proof::GalleryStack& entry : proof::gallery_stacks())
    if (entry.grid.diagrams.size() > 2)
      inputs.push_back(
          {entry.name, entry.reason, std::move(entry.grid.diagrams[1]), std::move(entry.grid.diagrams[2])});

  // What single formulas are sensitive to.
  std::vector<double> phi;
  for (int i = 0; i <= 8; ++i) phi.push_back(pi<double> * i / 8);
  proof::Random random(1);
  const auto nearly = [&](double, double) { return 1 + 2e-6 * static_cast<double>(random()); };
  const std::vector<double> even{0, 0.2, 0.4, 0.6, 0.8, 1};
  const DiagramGrid first = tabulate(phi, even, nearly);
  inputs.push_back({"nearly-constant", "densities that differ in the sixth digit: leading terms are all rounding",
                    first, tabulate(phi, even, nearly)});
  const DiagramGrid ring =
      tabulate(phi, {0, 2e-4, 4e-4, 5e-4, 6e-4, 8e-4, 2e-3, 0.1, 0.4, 0.7, 1},
               [](double, double r) { return 1e-7 + std::exp(-std::pow((r - 5e-4) / 8e-5, 2) / 2); });
  inputs.push_back({"pole-ring", "a ring of 0.04 degrees about the pole: a mirror at normal incidence", ring, ring});
  inputs.push_back({"theta-worst", "pole and horizon only, 1 and 0: the worst case of M_E in the paper",
                    tabulate({0, pi<double>}, {0, 1}, [](double, double r) { return 1 - r; }),
                    tabulate({0, pi<double>}, {0, 1}, [](double p, double r) { return 1 - r + p * r; })});
  return inputs;
}

}  // namespace gonio
