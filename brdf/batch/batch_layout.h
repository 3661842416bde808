#pragma once

#include <vector>

#include <gonio/brdf/value/colour.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// Ascending incident angles, and as radii of the disk, by which they are found: a radius is at hand before its angle.
/// With a guide table: for each of the equal parts of [0, 1], the interval where its radii begin; they end at most
/// `guide_steps` intervals further on.
struct BatchAngles {
  explicit BatchAngles(const std::vector<float>& theta_i);

  int count;
  std::vector<float> values, radii;
  static constexpr int guide_parts = 1024;
  std::vector<int> guide;  ///< empty for a single angle
  int guide_steps = 0;

  std::size_t bytes() const noexcept;  ///< on the heap
};

/// The arrays of a stack that vector code reads: for every diagram a block of `stride` floats, all laid out for M
/// meridians and N parallels, the most that a diagram has. Cells, the intervals between two of them, lie in groups of
/// `group`, so that a look-up touches as few lines of the cache as can be: a search counts the groups that begin before
/// the mass given, then the cells of one group.
///
/// A block: phi, r, the mass before each group of meridians but the first, the mass along every meridian before each
/// of its groups of parallels but the first (before_row), the groups of meridians, the groups of parallels of every
/// meridian.
/// - A group of meridians: the mass before each of its cells (7), a gap, phi and mass of each of its 8 meridians in
/// turn.
/// - A group of parallels: the mass along the meridian before each of its cells (7), the densities at its 8 parallels,
/// a gap. It is a line of the cache.
/// What is searched ends in values that no number is above: phi and r behind their last lines, masses behind the last
/// cell. There is room for whole vectors, in phi and r from their second lines on.
struct BatchLayout {
  explicit BatchLayout(const Stack<float>& stack);

  static constexpr int group = 7, meridian_group = 24, parallel_group = 16;  ///< cells, floats, floats

  BatchAngles angles;
  int meridians, parallels, across, along;  ///< lines, and groups of cells
  bool half_azimuth, half_chart;
  Interpolation interpolation;
  /// Floats of a block, of what is stored of a meridian before its groups, and where the parts begin; phi is first.
  int stride, before_row, r, before_meridians, before_parallels, meridian_groups, parallel_groups;

  const float* values() const noexcept { return lines_.data()->x; }
  std::size_t bytes() const noexcept { return angles.bytes() + lines_.capacity() * sizeof(Line); }  ///< on the heap
  float whole_mass() const noexcept { return half_azimuth ? 0.5f : 1.0f; }  ///< Diagram::mass() but for rounding

 private:
  struct alignas(64) Line {  // of the cache
    float x[16];
  };
  std::vector<Line> lines_;
};

/// The cells of a Colour for vector code: four floats each, the last one 0, so that a cell is one load.
struct BatchColour {
  BatchColour(const Colour& colour, const BatchLayout& stack);  ///< empty for an empty one

  int side;
  BatchAngles angles;
  bool same_angles;           ///< as the stack's
  std::vector<float> values;  ///< angles x side/2 x side x 4
  /// In cells: a layer; the first of the last two rows; from a row to the next, from a layer to the next, 0 where there
  /// is but one.
  int layer, last_row, next_row, next_layer;

  std::size_t bytes() const noexcept { return angles.bytes() + values.capacity() * sizeof(float); }  ///< on the heap
};

}  // namespace gonio
