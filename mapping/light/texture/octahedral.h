#pragma once

#include <algorithm>
#include <cmath>

#include <gonio/mapping/charts/concentric.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

/// The equal-area octahedral map of Clarberg (2008) from the unit square to the sphere, with the
/// layout of pbrt-v4: the centre is +z, the corners are -z, +x is to the right and +y at larger v.
template <class T>
Vec3<T> octahedral_to_direction(SquarePoint<T> p) noexcept {
  const T u = 2 * p.u - 1, v = 2 * p.v - 1;
  const T from_diagonal = 1 - (std::abs(u) + std::abs(v));  // > 0: upper hemisphere
  const T r = 1 - std::abs(from_diagonal);
  const T phi = r == 0 ? T(0) : ((std::abs(v) - std::abs(u)) / r + 1) * pi<T> / 4;
  const T s = r * std::sqrt(2 - r * r);
  return {std::copysign(s * std::cos(phi), u), std::copysign(s * std::sin(phi), v),
          std::copysign(1 - r * r, from_diagonal)};
}

/// The inverse. @param w a unit vector.
template <class T>
SquarePoint<T> direction_to_octahedral(const Vec3<T>& w) noexcept {
  const T x = std::abs(w.x), y = std::abs(w.y), z = std::abs(w.z);
  const T r = std::min(std::sqrt((x * x + y * y) / (1 + z)), T(1));  // sqrt(1 - |z|)
  const T turn = std::atan2(y, x) * 2 / pi<T>;                       // 0 to 1 over the quadrant
  T u = r - turn * r, v = turn * r;
  if (w.z < 0) {  // mirrored at the quadrant's diagonal
    const T mirrored = 1 - v;
    v = 1 - u;
    u = mirrored;
  }
  return {(std::copysign(u, w.x) + 1) / 2, (std::copysign(v, w.y) + 1) / 2};
}

}  // namespace gonio
