#pragma once

#include <memory>
#include <optional>

#include <gonio/brdf/table/table.h>
#include <gonio/brdf/value/bsdf_sample.h>

namespace gonio {

/// The samplers that a stack is measured against, with the interface of Bsdf and the same rules
/// (one-sided, immutable, no allocation). f_r comes from the table.

/// Every direction of the hemisphere alike: pdf = 1 / 2 pi.
class UniformSampler {
 public:
  /// @throws Error if `table` is null.
  explicit UniformSampler(std::shared_ptr<const BrdfTable> table)
      : table_(required_table(std::move(table), "uniform sampler")) {}
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return table_->eval(wi, wo); }
  std::size_t bytes() const noexcept { return sizeof(*this); }

 private:
  std::shared_ptr<const BrdfTable> table_;
};

/// In proportion to the cosine: pdf = cos theta_o / pi.
class CosineSampler {
 public:
  /// @throws Error if `table` is null.
  explicit CosineSampler(std::shared_ptr<const BrdfTable> table)
      : table_(required_table(std::move(table), "cosine sampler")) {}
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return table_->eval(wi, wo); }
  std::size_t bytes() const noexcept { return sizeof(*this); }

 private:
  std::shared_ptr<const BrdfTable> table_;
};

/// The RGL format's own warp chain (RglTable::sample()). Its pdf integrates to 1 only roughly, and
/// some draws fall below the horizon and are empty.
class RglSampler {
 public:
  /// @throws Error if `table` is null or not an RGL table.
  explicit RglSampler(std::shared_ptr<const BrdfTable> table);
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return table_->eval(wi, wo); }
  /// The warps are part of the table, which evaluation needs anyway.
  std::size_t bytes() const noexcept { return sizeof(*this); }

 private:
  std::shared_ptr<const BrdfTable> table_;
  const RglTable* rgl_;
};

}  // namespace gonio
