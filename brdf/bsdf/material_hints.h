#pragma once

#include <array>
#include <functional>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <gonio/brdf/value/bsdf_sample.h>

namespace gonio {

/// Bsdf::albedo() and roughness(), from draws.
class MaterialHints {
 public:
  using Draw = std::function<std::optional<BsdfSample>(const glm::vec3& wi, const glm::vec2& u)>;

  /// Draws side x side stratified samples at each of 45 incident angles: milliseconds.
  explicit MaterialHints(const Draw& draw);

  glm::vec3 albedo(float theta_i) const noexcept;
  float roughness() const noexcept { return roughness_; }

 private:
  static constexpr int angles = 45;
  std::array<glm::vec3, angles> albedo_;
  float roughness_ = 1;
};

}  // namespace gonio
