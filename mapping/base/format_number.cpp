#include <cmath>
#include <cstdio>

#include <gonio/mapping/base/format_number.h>

namespace gonio {

std::string format_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.7g", value == 0 ? 0 : value);  // -0 is 0
  return text;
}

std::string format_quantity(double value) {
  char text[400];
  const bool small = value != 0 && std::abs(value) < 1;
  std::snprintf(text, sizeof text, small ? "%.4g" : "%.2f", value);
  return text;
}

}  // namespace gonio
