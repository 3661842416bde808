#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/vec3.hpp>

#include <gonio/mapping/charts/concentric.h>
#include <gonio/mapping/numeric/fast_math.h>

namespace gonio {

template <class T>
using Vec3 = glm::vec<3, T, glm::defaultp>;

/// Polar coordinates on the disk that the hemisphere lies flattened on: r = sqrt(1 - cos theta)
/// (Havran et al. 2003, eq. 3; their eq. 6, "r = sqrt(1 - theta^2)", is a misprint), phi in
/// [-pi, pi]. The solid angle element is 2 r dr dphi. `gap` is 1 - r, the way to the horizon: there it has
/// digits that r has not, and densities that fall to 0 at the horizon have no others.
template <class T>
struct Polar {
  T r = T(0), phi = T(0), gap = 1 - r;
};

/// The least gap of a drawn direction: what lies nearer to the horizon counts as this far from it. cos theta is
/// then an epsilon of T.
template <class T>
inline const T least_gap = std::numeric_limits<T>::epsilon() / 2;

/// M_E, eqs. 2 and 3: disk to upper hemisphere. @param p r in [0, 1].
/// @return a unit vector; relative error of each component at most 4 ulp, also next to the pole.
template <class T>
Vec3<T> polar_to_direction(Polar<T> p) noexcept {
  const T sin_theta = p.r * std::sqrt(2 - p.r * p.r);  // sin^2 = (1 - cos)(1 + cos), no cancellation
  const SinCos<T> phi = sin_cos(p.phi);
  return {sin_theta * phi.cos, sin_theta * phi.sin, p.gap * (1 + p.r)};
}

/// The inverse of polar_to_direction(). @param w a unit vector with w.z >= 0.
/// r^2 is 1 - cos near the horizon, where that is exact, and sin^2 / (1 + cos) near the pole, where it
/// would lose all digits. r and gap have a relative error of at most 4 ulp for a `w` that is a unit vector to
/// rounding, phi that of fast_atan2().
template <class T>
Polar<T> direction_to_polar(const Vec3<T>& w) noexcept {
  const T r2 = select(w.z < T(0.5), 1 - w.z, (w.x * w.x + w.y * w.y) / (1 + w.z));
  const T r = std::min(std::sqrt(r2), T(1));
  return {r, fast_atan2(w.y, w.x), w.z / (1 + r)};
}

/// The parallel theta as a radius on the disk; theta in [0, pi/2]. sqrt(1 - cos) as sqrt(2)
/// sin(theta/2).
template <class T>
T theta_to_radius(T theta) noexcept {
  return std::sqrt(T(2)) * std::sin(theta / 2);
}

/// The angle to the horizon, pi/2 - theta, from the gap of a Polar; in [0, 1]. Relative error at most 4 ulp next to the
/// horizon.
template <class T>
T elevation(T gap) noexcept {
  return std::asin(std::min(gap * (2 - gap), T(1)));
}

/// The inverse of theta_to_radius(); r in [0, 1].
template <class T>
T radius_to_theta(T r) noexcept {
  return 2 * std::asin(r / std::sqrt(T(2)));
}

/// The same without a library call, which would be a fifth of a draw of a luminaire: relative error
/// below 2e-7. theta / r as a polynomial through 8 Chebyshev nodes of r^2 in [0, 1], whose own
/// relative error is 1.8e-8.
inline float radius_to_theta(float r) noexcept {
  const float z = r * r;
  float p = 1.211737771e-3f;
  p = p * z - 1.990642964e-3f;
  p = p * z + 3.338417016e-3f;
  p = p * z + 1.478859820e-3f;
  p = p * z + 8.216730964e-3f;
  p = p * z + 2.647448250e-2f;
  p = p * z + 1.178531667e-1f;
  p = p * z + 1.414213546f;
  return r * p;
}
inline float elevation(float gap) noexcept {
  if (gap > 0.125f) return 1.57079633f - radius_to_theta(1 - gap);
  const float z = gap * (2 - gap), z2 = z * z;  // the sine
  return z * (1 + z2 * (1 / 6.0f + z2 * (3 / 40.0f + z2 * (15 / 336.0f + z2 * (105 / 3456.0f)))));
}

}  // namespace gonio
