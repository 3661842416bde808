#pragma once

#include <cmath>

#include <glm/vec3.hpp>

#include <gonio/mapping/numeric/fast_math.h>

namespace gonio {

/// Whether `w` is a direction above the horizon; not if a component is NaN or infinite.
inline bool is_above(const glm::vec3& w) noexcept { return w.z > 0 && std::isfinite(w.x + w.y + w.z); }

/// The incident direction as the diagrams see it: its polar angle, and the rotation about the normal
/// that puts its azimuth on +x. At normal incidence, where there is no azimuth, +x itself is taken.
struct IncidentFrame {
  explicit IncidentFrame(const glm::vec3& wi) noexcept {
    const float sin_theta = std::sqrt(wi.x * wi.x + wi.y * wi.y);
    theta_i = fast_atan2(sin_theta, wi.z);
    if (sin_theta > 0) cos_phi = wi.x / sin_theta, sin_phi = wi.y / sin_theta;
  }

  /// From the frame of the diagram to that of the surface.
  glm::vec3 to_surface(const glm::vec3& w) const noexcept {
    return {cos_phi * w.x - sin_phi * w.y, sin_phi * w.x + cos_phi * w.y, w.z};
  }
  /// The inverse of to_surface().
  glm::vec3 to_diagram(const glm::vec3& w) const noexcept {
    return {cos_phi * w.x + sin_phi * w.y, cos_phi * w.y - sin_phi * w.x, w.z};
  }

  float theta_i;  ///< [rad], in [0, pi]
  float cos_phi = 1, sin_phi = 0;
};

}  // namespace gonio
