#pragma once

#include <cstddef>
#include <vector>

#include <gonio/brdf/build/compact/compact_quality.h>

namespace gonio::detail {

struct ColourFit {
  Colour colour;
  CompactQuality quality;
};

/// The colour of a stack with diagrams at `stack_angles`: the smallest whose evaluation error is at most `enough`,
/// or hardly larger than that of any of at most `finest_side` cells a side that fits into `bytes`; the smallest of
/// all if none fits. Cells and layers that can be spared are left out, as `draws` measures. Uses all cores.
ColourFit fit_colour(const BrdfTable& table, const DirectionMap& map, const std::vector<float>& stack_angles,
                     const CompactDraws& draws, int finest_side, std::size_t bytes, double enough);

}  // namespace gonio::detail
