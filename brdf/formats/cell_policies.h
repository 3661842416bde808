#pragma once

#include <cstdint>

namespace gonio {

/// What a reader does with a table cell that cannot be a BRDF value.
enum class CellPolicy {
  zero,   ///< the cell becomes 0
  fill,   ///< the cell takes the nearest valid value along its row (see each reader)
  reject  ///< loading throws Error
};

/// The policy for each kind of bad cell. NaN and infinite cells are never kept.
struct CellPolicies {
  CellPolicy negative = CellPolicy::zero;   ///< small negative values: measurement noise about 0
  CellPolicy nonfinite = CellPolicy::fill;  ///< NaN, +-Inf, and beyond 1e30
  CellPolicy missing = CellPolicy::fill;    ///< a format's own mark for "not measured" (MERL: < 0)
};

/// How many cells of each kind were met. `total` counts every cell of the table.
struct CellCounts {
  std::uint64_t total = 0, negative = 0, nonfinite = 0, missing = 0;
};

}  // namespace gonio
