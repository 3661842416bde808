#pragma once

#include <gonio/brdf/bsdf/bsdf_sample.h>

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace gonio {

/// What renderers ask of a material besides sample, pdf and eval: albedo for denoisers, light selection
/// and Russian roulette, a roughness for path guiding and regularisation.
///
/// Immutable; every const member may be called concurrently.
class MaterialHints {
 public:
  using Draw = std::function<std::optional<BsdfSample>(const glm::vec3& wi, const glm::vec2& u)>;

  /// Draws 64 x 64 stratified samples at each of 45 incident angles: milliseconds.
  explicit MaterialHints(const Draw& draw);

  /// Of a Sampler or a CompactBsdf.
  template <class Bsdf>
  static MaterialHints of(const Bsdf& bsdf) {
    return MaterialHints(Draw([&bsdf](const glm::vec3& wi, const glm::vec2& u) { return bsdf.sample(wi, u); }));
  }

  /// Directional albedo, the integral of f_r cos(theta_o), at an incident angle [rad]: the mean weight,
  /// within about 1 % of the albedo of the sampler's own f_r, linear between angles 2 degrees apart and constant beyond
  /// 88. 0 from pi/2 on.
  glm::vec3 albedo(float theta_i) const noexcept;

  /// An equivalent GGX alpha in [0, 1]: tan(theta_h) that half of what is reflected at normal
  /// incidence stays below, by luminance. Of a smooth GGX alone it is its alpha; rough ones lose their steepest facets to
  /// the horizon and to shadowing (0.32 of alpha 0.4); of a Lambertian it is 0.414. A lobe over a
  /// diffuse base has something between.
  float roughness() const noexcept { return roughness_; }

 private:
  static constexpr int angles = 45;
  std::array<glm::vec3, angles> albedo_;
  float roughness_ = 1;
};

}  // namespace gonio
