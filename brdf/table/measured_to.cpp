#include <cmath>

#include <gonio/brdf/table/measured_to.h>
#include <gonio/mapping/charts/concentric.h>

namespace gonio {
namespace {

/// The mean of BrdfTable::measured() over the pairs whose larger polar angle is theta.
double measured_share(const BrdfTable& table, double theta) {
  constexpr int n_other = 5, n_phi = 25;
  const glm::vec3 outer(std::sin(theta), 0, std::cos(theta));
  double measured = 0;
  for (int i = 0; i < n_other; ++i) {
    // Equal solid angles up to theta.
    const double z = 1 - (1 - std::cos(theta)) * (i + 0.5) / n_other, r = std::sqrt(1 - z * z);
    for (int j = 0; j < n_phi; ++j) {
      const double phi = pi<double> * (j + 0.5) / n_phi;
      const glm::vec3 inner(glm::dvec3(r * std::cos(phi), r * std::sin(phi), z));
      measured += static_cast<double>(table.measured(outer, inner) + table.measured(inner, outer));
    }
  }
  return measured / (2 * n_other * n_phi);
}

}  // namespace

double measured_to(const BrdfTable& table) {
  for (int degree = 90; degree > 0; --degree) {
    // Half, but for rounding, are tables of which one direction alone goes further.
    if (measured_share(table, (degree - 0.5) * pi<double> / 180) > 0.501) return degree * pi<double> / 180;
  }
  return 0;
}

}  // namespace gonio
