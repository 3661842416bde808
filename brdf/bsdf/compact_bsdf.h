#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include <gonio/brdf/bsdf/bsdf_sample.h>
#include <gonio/brdf/bsdf/colour.h>
#include <gonio/mapping/stack/any_stack.h>

namespace gonio {

/// A material that needs its table no more: the stack's densities and its Colour are the BSDF,
/// f_r = W pdf / max(cos theta_o, min_cosine). sample(), pdf() and eval() agree to rounding, whatever the distance to
/// the table.
/// The interface, the frame and what happens below the horizon are those of Sampler.
///
/// Thread safety: immutable; every const member may be called concurrently. No member but the
/// constructor allocates or locks.
class CompactBsdf {
 public:
  /// Next to the horizon W pdf does not fall to 0 as fast as the cosine does. There f_r stays what it is here.
  static constexpr float min_cosine = 1e-3f;

  /// @throws Error if `diagrams` cannot be held like that, or if `colour` is empty.
  CompactBsdf(const StackGrid& diagrams, Interpolation interpolation, Storage storage, Colour colour);

  /// Draws wo for `wi` from two uniform numbers in [0, 1). Empty for wi.z <= 0, and for a draw that
  /// falls on a direction without density (a measure-zero event).
  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;

  /// The density with which sample() draws wo [1/sr], within the bounds of Sampler::pdf().
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// f_r(wi, wo) per RGB channel [1/sr], without the cosine: one inversion of the map.
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  const Colour& colour() const noexcept { return colour_; }
  const AnyStack& stack() const noexcept { return stack_; }
  /// All memory held, this object included.
  std::size_t bytes() const noexcept { return stack_.bytes() + colour_.bytes(); }

 private:
  AnyStack stack_;
  Colour colour_;
};

}  // namespace gonio
