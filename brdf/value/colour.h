#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/mapping/charts/concentric.h>

namespace gonio {

/// The colour of a stack in the stack's own unit square: W(theta_i, u, v) = f_r cos theta_o / pdf per
/// RGB channel, at some incident angles of its own. Sampling has taken the peaks out of W, so a few
/// cells are enough for a BSDF that does without its table: f_r = W pdf / max(cos theta_o, min_cosine).
///
/// Cell-centred; `side` cells in u over [0, 1] and side/2 in v over [1/2, 1]: the lower half of the
/// square is the mirror image. Cells are 16-bit numbers (code16.h) in units of the largest: within 2^-12,
/// relative, of the value given, down to 2^-20 of the largest.
///
/// Thread safety: immutable; concurrent use is safe. No member but the constructors and values() allocates.
class Colour {
 public:
  /// Next to the horizon W pdf does not fall to 0 as fast as the cosine does. There f_r stays what it is here.
  static constexpr float min_cosine = 1e-3f;

  Colour() = default;

  /// @param theta_i K >= 1 incident angles [rad], ascending, in [0, pi/2].
  /// @param values K x side/2 x side weights, v slower than u. @throws Error for bad angles, a wrong count, or
  ///   values that are not from 0 to 1e6.
  Colour(std::vector<float> theta_i, int side, const std::vector<glm::vec3>& values);

  /// W at a point of the square: bilinear in (u, v), linear between the angles, constant beyond them.
  glm::vec3 eval(float theta_i, SquarePoint<float> at) const noexcept;

  bool empty() const noexcept { return codes_.empty(); }
  int side() const noexcept { return side_; }
  std::size_t cells() const noexcept { return codes_.size() / 3; }
  const std::vector<float>& theta_i() const noexcept { return theta_i_; }
  /// As they are stored; a colour made of them equals this one bit by bit.
  std::vector<glm::vec3> values() const;
  /// As they are stored, R, G, B in turn, and one more; in units of largest().
  const std::vector<std::uint16_t>& codes() const noexcept { return codes_; }
  float largest() const noexcept { return largest_; }
  std::size_t bytes() const noexcept {
    return sizeof(*this) + theta_i_.capacity() * sizeof(float) + codes_.capacity() * sizeof(std::uint16_t);
  }

 private:
  int side_ = 0;
  float largest_ = 0;
  std::vector<float> theta_i_;
  std::vector<std::uint16_t> codes_;  // R, G, B interleaved; one more, so that four can be read anywhere
};

}  // namespace gonio
