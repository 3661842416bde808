#pragma once

#include <gonio/brdf/table.h>

namespace gonio {

/// How far from the normal a table was measured. Of the pairs of directions whose larger polar angle
/// lies within the same degree, some may be read from measured cells and some from made-up ones.
struct MeasuredRange {
  /// Radians: the end of the last degree in which at least half of the pairs are measured; 0 if that
  /// holds for no degree.
  double theta = 0;

  /// The share of measured pairs up to there, by their solid angles, in [0, 1].
  double share = 0;
};

/// From a grid of 250 pairs for each degree; takes milliseconds. Thread-safe.
MeasuredRange measured_range(const BrdfTable& table);

}  // namespace gonio
