#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include <gonio/brdf/table.h>
#include <gonio/mapping/stack.h>

namespace gonio {

/// The colour of a stack in the stack's own unit square: W(theta_i, u, v) = f_r cos theta_o / pdf per
/// RGB channel, at the incident angles of the diagrams. Sampling has taken the peaks out of W, so a
/// few cells are enough for a BSDF that needs its table no more.
///
/// Cell-centred; `side` cells in u over [0, 1] and side/2 in v over [1/2, 1]: the lower half of the
/// square is the mirror image. Thread safety: immutable; concurrent use is safe.
class Colour {
 public:
  Colour() = default;

  /// @param values K x side/2 x side weights, v slower than u. @throws Error for a wrong count or
  ///   values that are negative or not finite.
  Colour(std::size_t angles, int side, std::vector<glm::vec3> values);

  /// The mean weight of every cell, by 8 x 8 stratified samples: the albedo of the table is kept.
  static Colour from_table(const BrdfTable& table, const Stack<float>& stack, int side);

  /// W at a point of the square: bilinear in (u, v), linear between the angles of `stack_angles`.
  glm::vec3 eval(const std::vector<float>& stack_angles, float theta_i, SquarePoint<float> at) const noexcept;

  bool empty() const noexcept { return values_.empty(); }
  int side() const noexcept { return side_; }
  const std::vector<glm::vec3>& values() const noexcept { return values_; }
  std::size_t bytes() const noexcept { return values_.capacity() * sizeof(glm::vec3); }

 private:
  glm::vec3 bilinear(std::size_t angle, SquarePoint<float> at) const noexcept;

  int side_ = 0;
  std::vector<glm::vec3> values_;
};

}  // namespace gonio
