#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <utility>

#include <gonio/brdf/bsdf/sampler.h>

namespace gonio {

/// The material interface of this renderer: one-sided, in the local frame, with the meaning of the
/// members as in Sampler.
class Bsdf {
 public:
  virtual ~Bsdf() = default;
  virtual std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept = 0;
  virtual float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept = 0;
  virtual glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept = 0;
};

/// Any of the library's samplers as a material.
template <class S>
class BsdfOf final : public Bsdf {
 public:
  explicit BsdfOf(S sampler) : sampler_(std::move(sampler)) {}
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept override { return sampler_.sample(wi, u); }
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept override { return sampler_.pdf(wi, wo); }
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept override { return sampler_.eval(wi, wo); }

 private:
  S sampler_;
};

template <class S>
std::shared_ptr<const Bsdf> make_bsdf(S sampler) {
  return std::make_shared<const BsdfOf<S>>(std::move(sampler));
}

/// f_r = albedo / pi, drawn in proportion to the cosine.
class LambertSampler {
 public:
  explicit LambertSampler(const glm::vec3& albedo) : albedo_(albedo) {}
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

 private:
  glm::vec3 albedo_;
};

}  // namespace gonio
