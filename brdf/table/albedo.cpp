#include <cmath>

#include <gonio/brdf/table/albedo.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio {

glm::vec3 directional_albedo(const BrdfTable& table, float theta_i, int resolution) noexcept {
  const glm::dvec3 wi(std::sin(theta_i), 0.0, std::cos(theta_i));
  const int n_theta = 2 * resolution, n_phi = 2 * resolution;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < n_theta; ++i) {
    // theta_h = (pi/2) s^2, as in the tables themselves.
    const double s = (i + 0.5) / n_theta, theta_h = pi<double> / 2 * s * s;
    const double solid_angle = std::sin(theta_h) * (pi<double> * s / n_theta) * (2 * pi<double> / n_phi);
    for (int j = 0; j < n_phi; ++j) {
      const double phi_h = 2 * pi<double> * (j + 0.5) / n_phi;
      const glm::dvec3 h(std::sin(theta_h) * std::cos(phi_h), std::sin(theta_h) * std::sin(phi_h), std::cos(theta_h));
      const double cosine = wi.x * h.x + wi.z * h.z;
      const glm::dvec3 wo = 2.0 * cosine * h - wi;
      if (cosine <= 0.0 || wo.z <= 0.0) continue;
      const glm::dvec3 f_r(table.eval(glm::vec3(wi), glm::vec3(wo)));
      sum += f_r * (wo.z * 4.0 * cosine * solid_angle);  // d omega_o = 4 (wi . h) d omega_h
    }
  }
  return glm::vec3(sum);
}

}  // namespace gonio
