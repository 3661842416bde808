#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

// Functions of float without branches and library calls: on random arguments either costs more than what is
// computed, and a mispredicted branch also ends the overlap of one look-up with the next. For other types, the
// standard library's.

#include <gonio/mapping/numeric/pi.h>

namespace gonio {

/// c ? a : b as arithmetic on bits: compilers turn that into a branch.
inline float select(bool c, float a, float b) noexcept {
  std::uint32_t bits_a, bits_b;
  std::memcpy(&bits_a, &a, sizeof a), std::memcpy(&bits_b, &b, sizeof b);
  const std::uint32_t mask = -static_cast<std::uint32_t>(c), bits = (bits_a & mask) | (bits_b & ~mask);
  std::memcpy(&a, &bits, sizeof a);
  return a;
}
template <class T>
T select(bool c, T a, T b) noexcept {
  return c ? a : b;
}

/// atan2(y, x) in [-pi, pi], relative error below 2e-7 for arguments whose larger is a normal number; 0 for x = y = 0.
///
/// Odd polynomial through atan(a)/a at 9 Chebyshev nodes of a^2 in [0, 1]: its own relative error is 1.8e-8.
inline float fast_atan2(float y, float x) noexcept {
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = std::max(std::max(ax, ay), std::numeric_limits<float>::min());
  const float a = std::min(ax, ay) / larger;
  const float z = a * a, z2 = z * z, z4 = z2 * z2;
  const float p01 = -3.333303671e-1f + 1.999187203e-1f * z, p23 = -1.419779779e-1f + 1.061837064e-1f * z;
  const float p45 = -7.456854825e-2f + 4.213762358e-2f * z, p67 = -1.573124912e-2f + 2.766283500e-3f * z;
  float p = a + a * z * ((p01 + z2 * p23) + z4 * (p45 + z2 * p67));  // the constant term is 1 to 2e-8
  p = select(ay > ax, 0.5f * pi<float> - p, p);
  p = select(x < 0.0f, pi<float> - p, p);
  return std::copysign(p, y);
}
template <class T>
T fast_atan2(T y, T x) noexcept {
  return std::atan2(y, x);
}

template <class T>
struct SinCos {
  T sin, cos;
};
/// Sine and cosine of |x| <= 8, errors below 1e-7 besides half the last digit of x. Cephes' polynomials (sinf.c) over
/// an eighth of a turn either side of the axes.
inline SinCos<float> sin_cos(float x) noexcept {
  const int k = static_cast<int>(x * 0.636619772f + std::copysign(0.5f, x));  // the nearest axis, in quarter turns
  const auto quarter = static_cast<float>(k);
  const float t = (x - quarter * 1.5703125f) - quarter * 4.83826792e-4f;  // pi / 2; the first product is exact
  const float z = t * t;
  const float s = t + t * z * (-1.6666654611e-1f + z * (8.3321608736e-3f - 1.9515295891e-4f * z));
  const float c =
      (1 - 0.5f * z) + z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + 2.443315711809948e-5f * z));
  const bool odd = (k & 1) != 0;
  const float sine = select(odd, c, s), cosine = select(odd, s, c);
  return {select((k & 2) != 0, -sine, sine), select(((k + 1) & 2) != 0, -cosine, cosine)};
}
template <class T>
SinCos<T> sin_cos(T phi) noexcept {
  return {std::sin(phi), std::cos(phi)};
}

/// A cube root, and 1 over it.
template <class T>
struct CubeRoot {
  T root, inverse;
};
/// Of x >= 0; relative errors below 3e-7 where x is a normal number, a root below 1e-12 elsewhere.
///
/// The inverse root without a division: a third of the exponent taken from the bits (18 % of x y^3 between the
/// extremes), a quadratic through 3 Chebyshev nodes of that range, which leaves 3e-5, and a step of Newton's.
inline CubeRoot<float> cube_root(float x) noexcept {
  x = std::max(x, std::numeric_limits<float>::min());
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof x);
  bits = 0x548f0000u - bits / 3;
  float y;
  std::memcpy(&y, &bits, sizeof y);
  const float c = (x * y) * (y * y);
  y *= 1.72261893f - c * (1.16826499f - 0.451924025f * c);
  const float root = x * y * y, rest = 1 - root * y;
  return {root + root * rest * (2 / 3.0f), y + y * rest * (1 / 3.0f)};
}
template <class T>
CubeRoot<T> cube_root(T x) noexcept {
  using std::cbrt;  // other types of T bring their own
  const T root = cbrt(x);
  return {root, root > 0 ? 1 / root : T(0)};
}

/// cos(acos(x) / 3) for x in [-1, 1], relative error below 3e-7. Its square root at x = -1 taken out the function is
/// analytic: a polynomial through 9 Chebyshev nodes of sqrt((1 + x) / 2), whose own relative error is 7e-9.
inline float cos_third(float x) noexcept {
  const float y = std::sqrt(0.5f * x + 0.5f), y2 = y * y, y4 = y2 * y2;
  const float p01 = 0.5000000037f + 0.5773496614f * y, p23 = -0.1110944928f + 0.05327935085f * y;
  const float p45 = -0.03192541214f + 0.01960032094f * y, p67 = -0.01023750833f + 0.003654119569f * y;
  return (p01 + y2 * p23) + y4 * ((p45 + y2 * p67) - 0.0006260453235f * y4);
}
template <class T>
T cos_third(T x) noexcept {
  using std::acos, std::cos;
  return cos(acos(x) / 3);
}

}  // namespace gonio
