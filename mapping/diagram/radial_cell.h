#pragma once

#include <algorithm>
#include <cmath>

#include <gonio/mapping/numeric/fast_math.h>

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
  /// A cell counted from its end (see from_end()) is inverted as well.
  ///
  /// @param tau in (0, 1]. @pre mass(1) is not 0.
  T invert(T tau) const noexcept {
    using std::sqrt;  // other types of T bring their own
    const T delta = d1 - d0, third = T(1) / 3;
    const T scale = 1 / (r0 * (d0 + d1) + h * (d0 + 2 * d1) * third);
    const T c = 2 * r0 * d0 * scale, c3 = c * third;
    const T b = (r0 * delta + h * d0) * scale;
    const T a = 2 * h * delta * third * scale;

    const T p3 = std::max(b * tau * third + c3 * c3, T(0));      // P / 3
    const T q2 = c3 * c3 * c3 + (b * c3 + a * tau) * (tau / 2);  // Q / 2
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

  /// The same cell counted from its end, the radius r1, inwards: h is negative, and so are its masses.
  RadialCell from_end(T r1) const noexcept { return {r1, T(-h), d1, d0}; }

  T radius(T s) const noexcept { return r0 + s * h; }
  /// 1 - radius(s); next to the horizon, in a cell that is counted from there, to all digits.
  T gap(T s) const noexcept { return (1 - r0) - s * h; }

  /// The density at a radius and its gap, r1 being the radius of the end. Next to an end at the horizon the gap has
  /// the digits.
  T density_at(T r, T to_horizon, T r1) const noexcept {
    const T s = std::clamp((r - r0) / h, T(0), T(1)), t = std::clamp((r1 < 1 ? r1 - r : to_horizon) / h, T(0), T(1));
    return t < T(0.5) ? (1 - t) * d1 + t * d0 : density(s);
  }
};

/// Where a draw falls in a cell.
template <class T>
struct RadialPlace {
  RadialCell<T> cell;  ///< counted from its start or from its end
  T s;

  /// @param inside the mass from the start of the cell to the draw. @param beyond the mass of the meridian behind the
  ///   draw, to all its digits. @param last whether the cell is the last one with mass: then its outer half is counted
  ///   from its end, by `beyond`. `inside` is a difference of larger masses: it says little about the end of a cell
  ///   whose density falls to 0 there.
  static RadialPlace of(const RadialCell<T>& cell, T r1, T inside, T beyond, bool last) noexcept {
    const T mass = cell.mass(1);
    const bool from_end = last && 2 * beyond < mass;
    const T part = select(from_end, beyond, inside);
    const RadialCell<T> c{select(from_end, r1, cell.r0), select(from_end, T(-cell.h), cell.h),
                          select(from_end, cell.d1, cell.d0), select(from_end, cell.d0, cell.d1)};
    return {c, part > 0 && mass > 0 ? c.invert(std::min(part / mass, T(1))) : T(0)};
  }

  T r() const noexcept { return cell.radius(s); }
  T gap() const noexcept { return cell.gap(s); }
  T density() const noexcept { return cell.density(s); }
  /// The place, moved to at least `at_horizon` from the horizon and, in a cell that is counted from an end elsewhere,
  /// `inside` from there: where the density falls to 0, radii must hold the distance.
  RadialPlace off_end(T at_horizon) const noexcept {
    if (gap() < at_horizon) return {cell, std::clamp(((1 - cell.r0) - at_horizon) / cell.h, T(0), T(1))};
    return {cell, cell.h < 0 && cell.r0 < 1 && -s * cell.h < inside() ? std::min(-inside() / cell.h, T(1)) : s};
  }
  static T inside() noexcept { return 256 * std::numeric_limits<T>::epsilon(); }
};

}  // namespace gonio
