#pragma once

#include <gonio/brdf/table/table.h>

namespace gonio {

/// Angles from the normal from which on f_r no longer changes, in whole degrees, to one: 90 if it changes to the end,
/// 0 if it never changes.
struct FlatFrom {
  int theta_i = 90;  ///< of `wi`, whatever `wo` is
  int theta_o = 90;  ///< of `wo`, whatever `wi` is
};

/// Where a table is constant up to the horizon, as where it repeats its last measured cells. Changes under a
/// part in 10,000 do not count. Compares 64 directions at each degree, in milliseconds. Thread-safe.
FlatFrom flat_from(const BrdfTable& table);

}  // namespace gonio
