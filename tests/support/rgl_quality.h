#pragma once

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/brdf/resample/rgl_resample.h>

namespace gonio::test {

/// What an RGL file makes of a reflectance at one incident angle.
struct RglQuality {
  double error;     ///< relative L1 of f_r cos(theta_o), over all channels
  double integral;  ///< of the pdf over the hemisphere
};

/// By n x n half vectors on the chart of the format, where its densities are smooth.
inline RglQuality measure(const RglTable& table, const Reflectance& f_r, double degrees, int n = 200) {
  constexpr double pi = 3.14159265358979323846;
  const double theta_i = degrees * pi / 180;
  const glm::dvec3 wi(std::sin(theta_i), 0.0, std::cos(theta_i));
  const glm::vec3 k(wi);
  double error = 0, sum = 0, integral = 0;
  for (int i = 0; i < n; ++i) {
    const double u = (i + 0.5) / n, theta = pi / 2 * u * u;
    for (int j = 0; j < n; ++j) {
      const double phi = 2 * pi * (j + 0.5) / n;
      const glm::dvec3 m(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double cosine = glm::dot(wi, m);
      const glm::dvec3 direction = 2.0 * cosine * m - wi;
      if (!(cosine > 0 && direction.z > 0)) continue;
      const double solid_angle = 4 * cosine * 2 * pi * pi * u * std::sin(theta) / (n * n);
      const glm::vec3 wo(direction), expected = f_r(k, wo);
      const glm::vec3 difference = glm::abs(table.eval(k, wo) - expected);
      error += solid_angle * wo.z * (difference.r + difference.g + difference.b);
      sum += solid_angle * wo.z * (expected.r + expected.g + expected.b);
      integral += solid_angle * table.pdf(k, wo);
    }
  }
  return {sum > 0 ? error / sum : 0.0, integral};
}

}  // namespace gonio::test
