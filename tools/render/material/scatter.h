#pragma once

#include <memory>
#include <optional>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <gonio/brdf/value/bsdf_sample.h>

namespace gonio {

/// What this renderer asks of a material, whatever samples it: one-sided, in the local frame, with the meaning of the
/// members as in Bsdf.
class Scatter {
 public:
  virtual ~Scatter() = default;
  virtual std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept = 0;
  virtual float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept = 0;
  virtual glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept = 0;
};

/// Any of the library's samplers as that.
template <class S>
class ScatterOf final : public Scatter {
 public:
  explicit ScatterOf(S sampler) : sampler_(std::move(sampler)) {}
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept override {
    return sampler_.sample(wi, u);
  }
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept override { return sampler_.pdf(wi, wo); }
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept override { return sampler_.eval(wi, wo); }

 private:
  S sampler_;
};

template <class S>
std::shared_ptr<const Scatter> make_scatter(S sampler) {
  return std::make_shared<const ScatterOf<S>>(std::move(sampler));
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
