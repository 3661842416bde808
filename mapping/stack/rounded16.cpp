#include <algorithm>
#include <string>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/code16.h>
#include <gonio/mapping/stack/rounded16.h>

namespace gonio {

StackGrid rounded16(const StackGrid& grid) {
  // Checks the grid, and rounds lines and angles.
  StackGrid rounded = Stack<float>(grid, Interpolation::nearest).grid();
  for (std::size_t k = 0; k < rounded.diagrams.size(); ++k) {
    DiagramGrid& d = rounded.diagrams[k];
    const std::vector<double>& given = grid.diagrams[k].density;
    const double largest = *std::max_element(given.begin(), given.end());
    std::transform(given.begin(), given.end(), d.density.begin(),
                   [largest](double density) { return double{decode16(encode16(density / largest))}; });
    double mass = 0;
    for (std::size_t i = 0; i + 1 < d.phi.size(); ++i)
      for (std::size_t j = 0; j + 1 < d.r.size(); ++j)
        for (const std::size_t side : {i, i + 1})
          mass += (d.phi[i + 1] - d.phi[i]) / 2 *
                  RadialCell<double>{d.r[j], d.r[j + 1] - d.r[j], d.at(side, j), d.at(side, j + 1)}.mass(1);
    const double scale = (d.azimuth == Azimuth::half ? 0.5 : 1.0) / mass;
    if (!(scale < 1e38))
      throw Error("stack: diagram " + std::to_string(k) + ": found a mass of " + std::to_string(mass) +
                  " of its largest density, expected more");
    for (double& density : d.density) density *= static_cast<double>(static_cast<float>(scale));
  }
  return rounded;
}

}  // namespace gonio
