#pragma once

#include <vector>

#include <gonio/mapping/stack.h>

namespace gonio {

/// The arrays of a stack in one block that vector code gathers from: theta_i (K), then K blocks of
/// `stride` floats, every diagram padded to M meridians and N parallels by repeating its last ones. A padding
/// cell has no width and no mass, so that searches end before it.
///
/// A block: phi (M), mass up to each meridian (M), mass of each meridian (M), r (N), then density and mass
/// up to each parallel (M x N each).
struct BatchLayout {
  explicit BatchLayout(const Stack<float>& stack);

  int angles, meridians, parallels, stride;
  bool half_azimuth, half_chart;
  Interpolation interpolation;
  std::vector<float> values;

  int cumulative_phi() const noexcept { return meridians; }
  int mass() const noexcept { return 2 * meridians; }
  int r() const noexcept { return 3 * meridians; }
  int density() const noexcept { return r() + parallels; }
  int cumulative() const noexcept { return density() + meridians * parallels; }
};

}  // namespace gonio
