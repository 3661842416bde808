#pragma once

#include <algorithm>
#include <cmath>

namespace gonio {

/// cos(acos(x) / 3) for x in [-1, 1].
template <class T>
T cos_third(T x) noexcept {
  using std::acos, std::cos;
  return cos(acos(x) / 3);
}
/// Without the two library calls, relative error below 3e-7. Its square root at x = -1 taken out the function is analytic:
/// a polynomial through 9 Chebyshev nodes of sqrt((1 + x) / 2), whose own relative error is 7e-9.
inline float cos_third(float x) noexcept {
  const float y = std::sqrt(0.5f * x + 0.5f), y2 = y * y, y4 = y2 * y2;
  const float p01 = 0.5000000037f + 0.5773496614f * y, p23 = -0.1110944928f + 0.05327935085f * y;
  const float p45 = -0.03192541214f + 0.01960032094f * y, p67 = -0.01023750833f + 0.003654119569f * y;
  return (p01 + y2 * p23) + y4 * ((p45 + y2 * p67) - 0.0006260453235f * y4);
}

/// One cell of a meridian between the radii r0 and r0 + h, with a density that is linear in r
/// (Havran et al. 2003, eq. 7): d(s) = d0 + (d1 - d0) s at r(s) = r0 + h s, s in [0, 1].
/// r0 >= 0, h > 0, d0, d1 >= 0.
template <class T>
struct RadialCell {
  T r0, h, d0, d1;

  T density(T s) const noexcept { return (1 - s) * d0 + s * d1; }

  /// The integral of d 2 r dr from r0 to r(s): eq. 9 without the difference of cubes, so that
  /// every term is non-negative and narrow cells far from the pole keep their digits.
  T mass(T s) const noexcept {
    const T ds = density(s);
    return s * h * (r0 * (d0 + ds) + s * h * (d0 + 2 * ds) / 3);
  }

  /// The s in [0, 1] below which the fraction `tau` of the cell's mass lies: the root of eq. 11.
  ///
  /// The mass is a s^3 + b s^2 + c s. Written for w = 1/s the cubic has the coefficient tau in
  /// front, not the one that vanishes with d1 - d0, so that constant, linear and steep cells are
  /// one case; shifted by c/3 it becomes z^3 - P z - Q = 0 with z = tau w - c/3, P >= 0, whose
  /// largest real root is the wanted one, and s = tau / (z + c/3) is a quotient of positive sums.
  /// A constant number of operations; backward stable: |mass(s)/mass(1) - tau| <= 16 ulp(1).
  ///
  /// @param tau in (0, 1]. @pre mass(1) > 0.
  T invert(T tau) const noexcept {
    using std::cbrt, std::sqrt;  // other types of T bring their own
    const T delta = d1 - d0;
    const T scale = 1 / (r0 * (d0 + d1) + h * (d0 + 2 * d1) / 3);
    const T c = 2 * r0 * d0 * scale;
    const T b = (r0 * delta + h * d0) * scale;
    const T a = 2 * h * delta * scale / 3;

    const T p3 = std::max((b * tau + c * c / 3) / 3, T(0));            // P / 3
    const T q2 = c * c * c / 27 + (b * c / 3 + a * tau) * tau / 2;     // Q / 2
    const T root_p3 = sqrt(p3);
    const T cube = p3 * root_p3;
    T z;
    if (q2 >= cube) {  // one real root: Cardan, here a sum of positive terms
      const T t = cbrt(q2 + sqrt(q2 - cube) * sqrt(q2 + cube));
      z = t > 0 ? t + p3 / t : T(0);
    } else {  // three: the trigonometric form; the angle is in [0, pi/3], so the cosine is >= 1/2
      z = 2 * root_p3 * cos_third(std::max(q2 / cube, T(-1)));
    }
    const T denominator = z + c / 3;
    return denominator > tau ? tau / denominator : T(1);
  }
};

}  // namespace gonio
