#pragma once

#include <gonio/brdf/table/table.h>

namespace gonio {

/// To which angle from the normal a table was measured, in radians: the end of the last degree of which
/// more than half is measured; 0 if there is none. Pairs of directions belong to the degree of their
/// larger polar angle, and count by their solid angles and BrdfTable::measured().
///
/// Asks for 250 pairs a degree, in milliseconds. Thread-safe.
double measured_to(const BrdfTable& table);

}  // namespace gonio
