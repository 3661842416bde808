#include <gonio/brdf/measured_range.h>
#include <gonio/mapping/concentric.h>

#include <cmath>

namespace gonio {
namespace {

/// The share of measured pairs whose larger polar angle is theta.
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
      // A value is that of the nearest cell for more than half.
      measured += (table.measured(outer, inner) >= 0.5f) + (table.measured(inner, outer) >= 0.5f);
    }
  }
  return measured / (2 * n_other * n_phi);
}

}  // namespace

MeasuredRange measured_range(const BrdfTable& table) {
  constexpr double degree = pi<double> / 180;
  MeasuredRange range;
  double measured = 0, all = 0;
  for (int k = 0; k < 90; ++k) {
    const double theta = (k + 0.5) * degree, share = measured_share(table, theta);
    const double weight = (1 - std::cos(theta)) * std::sin(theta);
    measured += weight * share;
    all += weight;
    if (share >= 0.5) range = {(k + 1) * degree, measured / all};
  }
  return range;
}

}  // namespace gonio
