#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gonio/fitting/lobes/angles.h>

namespace gonio::detail {

/// Quadrature over reflected directions by half vectors: theta_h spaced as the cube, dense about the
/// normal where narrow lobes are; phi over half the circle by mirror symmetry. Calls
/// f(wo, d_wo) for the half vectors whose wo is above the horizon and with wi.h > least_cos_d; d_wo is
/// the solid angle [sr] of both mirror images of wo.
template <class F>
void for_half_vectors(const glm::dvec3& wi, double least_cos_d, const F& f) {
  constexpr int n_theta = 96, n_phi = 24;
  for (int i = 0; i < n_theta; ++i) {
    const double s = (i + 0.5) / n_theta, theta = s * s * s * pi<double> / 2;
    const double d_theta = 3 * s * s * pi<double> / 2 / n_theta;
    for (int j = 0; j < n_phi; ++j) {
      const double phi = pi<double> * (j + 0.5) / n_phi;
      const glm::dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double cos_d = glm::dot(wi, h);
      const glm::dvec3 wo = reflect_about(wi, h);
      if (!(cos_d > least_cos_d && wo.z > 0)) continue;
      f(wo, 4 * cos_d * std::sin(theta) * d_theta * 2 * pi<double> / n_phi);
    }
  }
}

}  // namespace gonio::detail
