#pragma once

#include <algorithm>
#include <cmath>

#include <glm/vec3.hpp>

namespace gonio {

/// Two neighbouring nodes and the weight of the upper one, in [0, 1].
struct Lerp {
  int lo = 0, hi = 0;
  float t = 0.0f;
};

/// Neighbours of position x on nodes 0 ... n-1, clamped to the ends. NaN gives node 0, so that a
/// broken direction never becomes a broken index.
inline Lerp lerp_clamped(float x, int n) noexcept {
  const float clamped = std::min(std::max(0.0f, x), static_cast<float>(n - 1));
  const int lo = static_cast<int>(clamped);
  return {lo, std::min(lo + 1, n - 1), clamped - static_cast<float>(lo)};
}

/// Neighbours of position x in [-1, n] on n nodes that repeat with period n. NaN gives node 0.
inline Lerp lerp_periodic(float x, int n) noexcept {
  if (!(x >= -1.0f && x <= static_cast<float>(n))) return {0, 0, 0.0f};
  const float base = std::floor(x);
  const int lo = static_cast<int>(base);
  const auto wrap = [n](int i) { return i < 0 ? i + n : i >= n ? i - n : i; };
  return {wrap(lo), wrap(lo + 1), x - base};
}

template <class T>
T lerp(const T& a, const T& b, float t) noexcept {
  return a + (b - a) * t;
}

}  // namespace gonio
