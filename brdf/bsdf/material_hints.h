#pragma once

#include <array>
#include <cstddef>
#include <functional>

#include <glm/vec3.hpp>

#include <gonio/brdf/value/arrays3.h>

namespace gonio {

/// Bsdf::albedo() and roughness(), from draws.
class MaterialHints {
 public:
  /// Bsdf::sample_n().
  using Draw = std::function<void(std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo,
                                  float* pdf, Arrays3 weight)>;

  /// Draws side x side stratified samples at each of 45 incident angles: a millisecond.
  explicit MaterialHints(const Draw& draw);

  glm::vec3 albedo(float theta_i) const noexcept;
  float roughness() const noexcept { return roughness_; }

 private:
  static constexpr int angles = 45;
  std::array<glm::vec3, angles> albedo_;
  float roughness_ = 1;
};

}  // namespace gonio
