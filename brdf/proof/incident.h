#pragma once

#include <cmath>

#include <glm/vec3.hpp>

namespace gonio::proof {

/// The incident direction at theta_i [rad] that subjects are asked for: in the plane y = 0.
inline glm::vec3 incident(double theta_i) {
  return {static_cast<float>(std::sin(theta_i)), 0, static_cast<float>(std::cos(theta_i))};
}

}  // namespace gonio::proof
