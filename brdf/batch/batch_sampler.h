#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/bsdf/compact_bsdf.h>
#include <gonio/brdf/bsdf/sampler.h>

namespace gonio {

/// Three arrays: directions by component, or colours by channel.
struct ConstArrays3 {
  const float *x, *y, *z;
};
struct Arrays3 {
  float *x, *y, *z;
  operator ConstArrays3() const noexcept { return {x, y, z}; }
};

/// A Sampler or CompactBsdf laid out for speed: for many look-ups at once, as BatchStack with the frame of the surface and with RGB, and
/// for single ones. In batches every element has its own wi. All arrays hold `count` floats, in any alignment; an output must not
/// overlap an input.
///
/// A CompactBsdf runs on vectors throughout, in 32 bits whatever its storage. A Sampler does for direction and pdf; f_r is looked up
/// in the table one element at a time, since the formats' own look-ups have little in common: there most of the time goes.
///
/// Results are those of Sampler or CompactBsdf but for rounding: directions within 1e-4 wherever the map is no steeper than that lets
/// floats; the pdf of a direction within 2e-3, relative, besides 1e-4 of the largest density; weights within 1e-5, relative, of what its
/// colour says at (u, v), or the table at the direction and pdf returned; f_r of a CompactBsdf as exact as the pdf
/// that it is computed from.
///
/// Memory: a copy of the stack in 32 bits, padded (see BatchStack), and of the colour with four floats a cell; a table is shared.
/// Thread safety: immutable; concurrent use is safe. No member but the constructor allocates.
class BatchSampler {
 public:
  /// @throws Error as BatchStack does.
  explicit BatchSampler(const Sampler& sampler);
  explicit BatchSampler(const CompactBsdf& bsdf);

  /// Sampler::sample() of every (wi, (u, v)). Where that is empty, all outputs are 0.
  void sample_n(std::size_t count, ConstArrays3 wi, const float* u, const float* v, Arrays3 wo, float* pdf,
                Arrays3 weight) const noexcept;

  /// Sampler::pdf() of every (wi, wo) [1/sr].
  void pdf_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, float* pdf) const noexcept;

  /// Sampler::eval() of every (wi, wo): f_r per channel [1/sr], without the cosine.
  void eval_n(std::size_t count, ConstArrays3 wi, ConstArrays3 wo, Arrays3 f_r) const noexcept;

  /// The same of one element, on vectors as well: what Sampler and CompactBsdf answer, nearly twice as fast, for the memory of the copy.
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  bool self_contained() const noexcept { return !table_; }
  /// All memory held, the shared table apart.
  std::size_t bytes() const noexcept { return sizeof(*this) + layout_.bytes() + colour_.bytes(); }

 private:
  BatchLayout layout_;
  BatchColour colour_;                      // empty: table-backed
  std::shared_ptr<const BrdfTable> table_;  // null: self-contained
};

}  // namespace gonio
