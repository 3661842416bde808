#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include <gonio/brdf/bsdf/bsdf_sample.h>
#include <gonio/brdf/build/build_stack.h>
#include <gonio/mapping/stack/any_stack.h>

namespace gonio {

/// What a renderer holds of a measured material: importance sampling, its pdf, and f_r, which comes from the
/// table, exactly. The sampler shares the ownership of the table. (CompactBsdf needs no table.)
///
/// Frame: local, the surface normal is +z; wi and wo are unit vectors that point away from the
/// surface; wi is the known direction, wo the sampled one. One-sided: for wi.z <= 0 or wo.z <= 0
/// there is no sample, pdf() and eval() are 0. A two-sided material flips both directions first.
///
/// Thread safety: immutable; every const member may be called concurrently. No member but the
/// constructors allocates or locks.
class Sampler {
 public:
  /// Every constructor throws Error if `table` is null.
  ///
  /// With the diagrams that fit_compact() chooses, in 16 bits, blended. Takes seconds.
  explicit Sampler(std::shared_ptr<const BrdfTable> table, const Progress& progress = {});

  /// With a stack of sizes set by hand, and its options' interpolation.
  Sampler(std::shared_ptr<const BrdfTable> table, const StackOptions& options, const Progress& progress = {});

  /// With diagrams that exist already (a stack file's, say). @throws Error as AnyStack does.
  Sampler(std::shared_ptr<const BrdfTable> table, const StackGrid& diagrams,
          Interpolation interpolation = Interpolation::displacement, Storage storage = Storage::float32);

  /// Draws wo for `wi` from two uniform numbers in [0, 1). Empty for wi.z <= 0, and for a draw that
  /// falls on a direction without density (a measure-zero event).
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;

  /// The density with which sample() draws wo [1/sr]. Differs from BsdfSample::pdf by rounding only
  /// (relative 2e-3 at most, besides 1e-4 of its peak).
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// f_r(wi, wo) per RGB channel [1/sr], without the cosine.
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  const AnyStack& stack() const noexcept { return stack_; }
  const std::shared_ptr<const BrdfTable>& table() const noexcept { return table_; }
  /// All memory held, the shared table apart.
  std::size_t bytes() const noexcept { return sizeof(*this) - sizeof(stack_) + stack_.bytes(); }

 private:
  std::shared_ptr<const BrdfTable> table_;  // before the stack, which is built of it
  AnyStack stack_;
};

}  // namespace gonio
