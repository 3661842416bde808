#pragma once

#include <vector>

#include <gonio/brdf/colour.h>
#include <gonio/mapping/stack.h>

namespace gonio {

/// The arrays of a stack in one block that vector code gathers from: theta_i (K), then K blocks of
/// `stride` floats, every diagram padded to M meridians and N parallels by repeating its last ones. A padding
/// cell has no width and no mass, so that searches end before it.
///
/// A block: phi (M), mass up to each meridian (M), mass of each meridian (M), r (N), then density and mass
/// up to each parallel (N x M each, meridians fastest: what is looked up lies between two of them, which are one load).
struct BatchLayout {
  explicit BatchLayout(const Stack<float>& stack);

  int angles, meridians, parallels, stride;
  bool half_azimuth, half_chart;
  Interpolation interpolation;
  std::vector<float> values;

  /// A guide table: for each of the equal parts of [0, pi/2], the cell of theta_i where its angles begin; they end at
  /// most `guide_steps` cells further on.
  static constexpr int guide_parts = 1024;
  std::vector<int> guide;
  int guide_steps;

  std::size_t bytes() const noexcept;  ///< on the heap

  int cumulative_phi() const noexcept { return meridians; }
  int mass() const noexcept { return 2 * meridians; }
  int r() const noexcept { return 3 * meridians; }
  int density() const noexcept { return r() + parallels; }
  int cumulative() const noexcept { return density() + meridians * parallels; }
  float whole_mass() const noexcept { return half_azimuth ? 0.5f : 1.0f; }  ///< Diagram::mass() but for rounding
};

/// The cells of a Colour for vector code: four floats each, the last one 0, so that a cell is one load.
struct BatchColour {
  explicit BatchColour(const Colour& colour);  ///< empty for an empty one

  int side;
  std::vector<float> theta_i;
  std::vector<float> values;  ///< angles x side/2 x side x 4

  std::size_t bytes() const noexcept { return (theta_i.capacity() + values.capacity()) * sizeof(float); }  ///< on the heap

  /// In cells. The second of two rows or layers is the first one where there is but one.
  int layer() const noexcept { return side * (side / 2); }
  int last_row() const noexcept { return side > 2 ? side / 2 - 2 : 0; }
  int next_row() const noexcept { return side > 2 ? side : 0; }
  int next_layer() const noexcept { return theta_i.size() > 1 ? layer() : 0; }
};

}  // namespace gonio
