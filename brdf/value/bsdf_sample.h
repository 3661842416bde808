#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace gonio {

/// A sampled direction of reflection.
struct BsdfSample {
  glm::vec3 wo;      ///< unit, wo.z > 0
  float pdf;         ///< per solid angle [1/sr], > 0
  glm::vec3 weight;  ///< f_r cos theta_o / pdf per RGB channel: what the path's throughput is multiplied by
};

}  // namespace gonio
