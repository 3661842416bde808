#include <cmath>

#include <gonio/mapping/charts/concentric.h>

#include "tools/render/material/scatter.h"

namespace gonio {

std::optional<BsdfSample> LambertSampler::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(wi.z > 0)) return std::nullopt;
  const DiskPoint<float> disk = square_to_disk(u.x, u.y);
  const float phi = 2 * pi<float> * disk.turn, r = std::sqrt(disk.r2), z = std::sqrt(1 - disk.r2);
  if (!(z > 0)) return std::nullopt;
  return BsdfSample{{r * std::cos(phi), r * std::sin(phi), z}, z / pi<float>, albedo_};
}

float LambertSampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return wi.z > 0 && wo.z > 0 ? wo.z / pi<float> : 0;
}

glm::vec3 LambertSampler::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return wi.z > 0 && wo.z > 0 ? albedo_ / pi<float> : glm::vec3(0);
}

}  // namespace gonio
