#pragma once

#include <vector>

#include <gonio/brdf/formats/interpolate.h>

namespace gonio {

/// A stack of densities on the unit square, each bilinear on a grid of height x width nodes (the
/// first and last nodes lie on the border), blended linearly between neighbouring slices.
///
/// Maps (u, v) in [0, 1)^2 to (x, y): y by inverting the marginal of the blended density with v, x
/// by inverting the conditional with u. Every member is thread-safe, allocates nothing and is
/// accurate to float rounding of the cumulative sums.
class Warp2d {
 public:
  struct Point {
    float x, y;     ///< in [0, 1]
    float density;  ///< of the blended slices at the point of the square, per unit area
  };

  Warp2d() = default;

  /// `density`: [slice][height][width], finite and >= 0, height and width >= 2. Every slice is
  /// scaled to integrate to 1; one that is 0 everywhere becomes uniform.
  Warp2d(int n_slices, int height, int width, const std::vector<float>& density);

  /// (u, v) -> (x, y) and the density there.
  Point sample(const Lerp& slice, float u, float v) const noexcept;

  /// The inverse of sample: (x, y) -> (u, v), with the density at (x, y).
  Point invert(const Lerp& slice, float x, float y) const noexcept;

  /// The density at (x, y).
  float eval(const Lerp& slice, float x, float y) const noexcept;

 private:
  const float* row(const std::vector<float>& grid, int slice, int y) const noexcept {
    return grid.data() + (static_cast<std::ptrdiff_t>(slice) * height_ + y) * width_;
  }

  int height_ = 0, width_ = 0;
  std::vector<float> density_;      // [slice][y][x]
  std::vector<float> conditional_;  // integral of density_ over x from 0, same shape
  std::vector<float> marginal_;     // [slice][y]: integral over y of the last column of conditional_
};

}  // namespace gonio
