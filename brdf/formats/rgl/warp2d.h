#pragma once

#include <cstddef>
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

  /// What an inverse needs of a node, and of a line of nodes, lies side by side.
  struct Node {
    float density;
    float before;  ///< the integral of the density over x from 0 to here
  };
  struct Line {
    float before;  ///< the integral of `mass` over y from 0 to here
    float mass;    ///< the integral of the density along the line
  };
  const Node* nodes() const noexcept { return nodes_.data(); }  ///< [slice][y][x]
  const Line* lines() const noexcept { return lines_.data(); }  ///< [slice][y]
  int height() const noexcept { return height_; }
  int width() const noexcept { return width_; }

 private:
  const Line* line(int slice, int y) const noexcept {
    return lines_.data() + static_cast<std::ptrdiff_t>(slice) * height_ + y;
  }
  const Node* row(int slice, int y) const noexcept {
    return nodes_.data() + (static_cast<std::ptrdiff_t>(slice) * height_ + y) * width_;
  }

  int height_ = 0, width_ = 0;
  std::vector<Node> nodes_;
  std::vector<Line> lines_;
};

}  // namespace gonio
