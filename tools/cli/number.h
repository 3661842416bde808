#pragma once

#include <cstdio>
#include <string>

namespace gonio {

/// `x` for people, with that many significant digits (at most 17).
inline std::string number(double x, int digits = 3) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

}  // namespace gonio
