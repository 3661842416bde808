#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// A stack for Interpolation::blend (see Stack, Blend) in about 2.6 bytes a crossing instead of 8: densities of
/// 16 bits on lines that all diagrams share, and the mass along a meridian at every eighth parallel alone. It is
/// the same map, charts and conventions included, of the rounded densities; half azimuths only.
///
/// Precision: a crossing is a 16-bit number (see code16.h) in units of the largest of its diagram, within 2^-12
/// of the value given, relative, in the 20 powers of two below the largest; a positive one stays positive. What is
/// stored is the truth: scale and masses derive from the rounded densities, in double, so that the pdf is exactly
/// that of the draws and integrates to 1 as well as that of Stack<float> does. There the pdf is within 2^-11,
/// relative, of that of Stack<double> on the densities given (2^-12 of the crossings, 2^-12 of the scale). Against
/// Stack<double> on grid() rounding to float alone is left: the pdf is within 4e-5, relative, the direction of
/// (u, v) within 1e-4, for lobes 0.1 wide up to theta_i = 1.5.
///
/// sample(), pdf() and invert() make a bounded number of operations: searches over lines and blocks, and a
/// pass over the eight cells of a block.
///
/// Thread safety: immutable; concurrent use is safe. No member but the constructor and grid() allocates.
class PackedStack {
 public:
  /// Rounds the densities of `grid`.
  /// @throws Error as Stack<float> with `blend` does, for full azimuths, and if the mass of a diagram is so small
  ///   against its largest density that its scale is beyond float.
  explicit PackedStack(const StackGrid& grid);

  /// The direction of (u, v) in [0, 1]^2 and its pdf. Angles outside the stack use its first or last diagram.
  DirectionSample<float> sample(float theta_i, float u, float v) const noexcept;

  /// The pdf of `wo` [1/sr]; integrates to 1 over the hemisphere; 0 for wo.z < 0. Of a draw, within the bounds of
  /// Stack::pdf() of the returned pdf.
  float pdf(float theta_i, const Vec3<float>& wo) const noexcept;

  /// The (u, v) that sample() maps to `wo`, with the pdf; empty for wo.z < 0 and where the density vanishes. The
  /// bounds are those of Stack::invert() for `blend`.
  std::optional<SquareInverse<float>> invert(float theta_i, const Vec3<float>& wo) const noexcept;

  Chart chart() const noexcept { return chart_; }
  const std::vector<float>& theta_i() const noexcept { return theta_i_; }
  std::size_t bytes() const noexcept;  ///< all memory held, this object included
  /// The densities as they are sampled, normalised; packing it again gives the same bits.
  StackGrid grid() const;

 private:
  class Blended;

  static constexpr int block = 8;  // cells

  const float* scale() const noexcept { return values_.data(); }
  const float* phi() const noexcept { return scale() + theta_i_.size(); }
  const float* r() const noexcept { return phi() + meridians_; }
  const float* cumulative_phi(int k) const noexcept { return r() + blocks_ * block + 1 + k * meridians_; }
  /// The mass of a meridian up to the end of each block.
  const float* ends(int k, int i) const noexcept {
    return cumulative_phi(static_cast<int>(theta_i_.size())) + (k * meridians_ + i) * blocks_;
  }
  const std::uint16_t* codes(int k, int i) const noexcept { return codes_.data() + (k * meridians_ + i) * parallels_; }

  Chart chart_;
  int meridians_, parallels_, blocks_;
  std::vector<float> theta_i_;
  // scale (K) | phi (M) | r, filled up to whole blocks by empty cells at 1 | mass up to each meridian (K x M) |
  // mass along each meridian up to the end of each block (K x M x blocks). Masses are in units of the scale.
  std::vector<float> values_;
  std::vector<std::uint16_t> codes_;  // K x M x N, and one block more that is read but has no cells
};

}  // namespace gonio
