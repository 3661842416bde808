#pragma once

#include <memory>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <gonio/brdf/table/table.h>
#include <gonio/brdf/value/bsdf_data.h>
#include <gonio/brdf/value/bsdf_sample.h>

namespace gonio {

/// A Bsdf in plain scalar code, by Stack<float> and Colour::eval(): what Bsdf is compared with, and the one that
/// samples mixtures, too. The interface, the frame and what happens below the horizon are those of Bsdf.
///
/// Thread safety: immutable; every const member may be called concurrently. No member but the constructor allocates or
/// locks.
class StackBsdf {
 public:
  /// @throws Error as sampled_stack() and sampled_colour() do.
  explicit StackBsdf(const BsdfData& data, std::shared_ptr<const BrdfTable> table = nullptr);

  std::optional<BsdfSample> sample(const glm::vec3& wi, const glm::vec2& u) const noexcept;
  /// Differs from BsdfSample::pdf by rounding only (relative 2e-3 at most, besides 1e-4 of its peak).
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  const Stack<float>& stack() const noexcept { return stack_; }
  /// All memory held, the shared table apart.
  std::size_t bytes() const noexcept {
    return sizeof(*this) - sizeof(stack_) - sizeof(colour_) + stack_.bytes() + colour_.bytes();
  }

 private:
  Stack<float> stack_;
  Colour colour_;
  std::shared_ptr<const BrdfTable> table_;  // null: f_r is the colour's
};

}  // namespace gonio
