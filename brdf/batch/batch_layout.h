#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gonio/brdf/value/colour.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// Ascending incident angles, and as radii of the disk, by which they are found: a radius is at hand before its angle.
/// With a guide table: for each of the equal parts of [0, 1], the interval where its radii begin; they end at most
/// `guide_steps` intervals further on, which is 1 where 1024 parts are enough for it.
struct BatchAngles {
  explicit BatchAngles(const std::vector<float>& theta_i);

  int count;
  std::vector<float> values, radii;
  int guide_parts = 0;
  std::vector<std::uint16_t> guide;  ///< empty for a single angle; one more, so that two can be read anywhere
  int guide_steps = 0;

  std::size_t bytes() const noexcept;  ///< on the heap
};

/// A stack as it is sampled: what all code of Bsdf reads, one element at a time or many. Densities are of 16 bits
/// (code16.h), in units of the largest of their diagram. All diagrams are laid out for M meridians and N parallels, the
/// most that one of them has.
///
/// Cells along a meridian lie in groups of 7. The 8 codes of a group's crossings are 16 bytes, and those of the next
/// meridian are behind them, so that a look-up touches one line of the cache for each diagram. Masses within a group
/// are computed from its densities; those before groups are stored.
///
/// | of each diagram | floats |
/// |---|---|
/// | `scale` | 1: the density that a half float of 1 stands for [1/sr] |
/// | `before` | M: the mass before each meridian, and 2 |
/// | `along` | M: the mass along each meridian |
/// | `starts` | M x (groups - 1): the mass along each meridian before each group but the first |
///
/// and its lines, of which there is one set where all diagrams share them: phi (M) and r (N). What has fewer lines than
/// others is filled up by values that no number is above, r by ones.
struct BatchLayout {
  /// Rounds to 16 bits. A stack that is rounded already (see rounded16()) stays what it is.
  /// @throws Error for Interpolation::mixture, and for stacks of 2^28 values or more.
  explicit BatchLayout(const Stack<float>& stack);

  /// What a diagram takes, and the lines that it may share with others.
  static std::size_t diagram_bytes(int meridians, int parallels) noexcept;
  static std::size_t lines_bytes(int meridians, int parallels) noexcept;

  static constexpr float beyond = 1e30f;  ///< above all numbers; small enough for weights and sums
  static constexpr int group = 7;         ///< cells
  static constexpr int group_codes = 8;   ///< its crossings

  BatchAngles angles;
  int meridians, parallels, groups;  ///< M, N, groups along a meridian
  bool half_azimuth, half_chart;
  Interpolation interpolation;
  /// From a diagram to the next: codes, floats, and lines, 0 where all share them.
  int code_stride, stride, lines_stride;
  int before, along, starts;  ///< where they begin among the floats of a diagram; `scale` is the first one
  int r;                      ///< where r begins among the lines; phi is first

  /// The first diagram, and the way to the next.
  struct Diagrams {
    const std::uint16_t* codes;
    const float *floats, *lines;
    std::ptrdiff_t code_stride, stride, lines_stride;
  };
  Diagrams diagrams() const noexcept {
    return {codes_.data(), floats_.data(), lines_.data(), code_stride, stride, lines_stride};
  }
  std::size_t bytes() const noexcept;                                       ///< on the heap
  float whole_mass() const noexcept { return half_azimuth ? 0.5f : 1.0f; }  ///< Diagram::mass() but for rounding

 private:
  std::vector<std::uint16_t> codes_;  // diagrams x groups x M x 8
  std::vector<float> floats_, lines_;
};

/// The cells of a Colour for vector code.
struct BatchColour {
  BatchColour(const Colour& colour, const BatchLayout& stack);  ///< empty for an empty one

  int side;
  float unit;  ///< what a half float of 1 stands for
  BatchAngles angles;
  bool same_angles;                  ///< as the stack's
  std::vector<std::uint16_t> codes;  ///< as Colour has them: angles x side/2 x side x RGB, and two more
  /// In cells: a layer; the first of the last two rows; from a row to the next, from a layer to the next, 0 where there
  /// is but one.
  int layer, last_row, next_row, next_layer;

  std::size_t bytes() const noexcept { return angles.bytes() + codes.capacity() * sizeof(std::uint16_t); }  ///< heap
};

}  // namespace gonio
