#pragma once

#include <string>

namespace gonio {

/// `value` with at most seven significant digits, the shortest such text; never "-0".
std::string format_number(double value);
/// `value` for people: two decimals, or four significant digits below 1.
std::string format_quantity(double value);

}  // namespace gonio
