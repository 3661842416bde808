#pragma once

#include <algorithm>
#include <cmath>

#include <gonio/mapping/fast_math.h>

namespace gonio {

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
    using std::sqrt;  // other types of T bring their own
    const T delta = d1 - d0, third = T(1) / 3;
    const T scale = 1 / (r0 * (d0 + d1) + h * (d0 + 2 * d1) * third);
    const T c = 2 * r0 * d0 * scale, c3 = c * third;
    const T b = (r0 * delta + h * d0) * scale;
    const T a = 2 * h * delta * third * scale;

    const T p3 = std::max(b * tau * third + c3 * c3, T(0));         // P / 3
    const T q2 = c3 * c3 * c3 + (b * c3 + a * tau) * (tau / 2);     // Q / 2
    const T root_p3 = sqrt(p3), cube = p3 * root_p3;
    // One real root (q2 >= cube): Cardan, here a sum of positive terms. Three: the trigonometric form, whose angle
    // is in [0, pi/3], so that the cosine is >= 1/2. Each form is 2 sqrt(P/3) where the other one holds, so that no
    // case is needed.
    const T larger = std::max(q2, cube);
    const CubeRoot<T> t = cube_root(larger + sqrt(larger - cube) * sqrt(larger + cube));
    const T trigonometric = cos_third(std::max(T(-1), q2 / larger));
    const T z = (t.root + p3 * t.inverse) + 2 * root_p3 * (trigonometric - 1);
    const T denominator = z + c3;
    return denominator > tau ? tau / denominator : T(1);
  }
};

}  // namespace gonio
