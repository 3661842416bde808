#pragma once

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

/// The half-vector chart of one incident direction: a bijection between the disk and the hemisphere of
/// outgoing directions by way of the half vector h = normalize(wi + wo), so that the mirror direction is
/// at the pole for every theta_i. x points along the azimuth of wi; phi is the azimuth of h.
///
/// Along the azimuth phi, wo stays above the horizon for theta_h up to theta_max(phi), where
///   wo.z = sin theta_i cos phi sin 2 theta_h + cos theta_i cos 2 theta_h >= 0            (1)
/// ends, 2 theta_max = atan2(cos theta_i, -sin theta_i cos phi). The disk covers these half vectors and
/// no others: with x = 1 - cos theta_h and m(phi) = 1 - cos theta_max(phi),
///   r^2 = q = a x / (1 - x/m + a x),   x = q / D,   D = a (1 - q) + q / m.                (2)
/// The scale a at the pole does not depend on phi, which keeps a round peak round and the density at the
/// pole one value; the rim is the horizon. Solid angles are
///   d omega_o = 4 (wi.h) d omega_h = 4 (wi.h) a / D^2 * 2 r dr dphi.                      (3)
/// a is the geometric mean of 1/m along phi = 0 and pi: a = (2 cos(theta_i / 2) + sqrt 2) / cos theta_i.
///
/// At grazing incidence m(pi) is 0 and a infinite: theta_i is clamped to `largest_theta_i`, beyond which
/// the chart is that of this angle (still a bijection onto the whole hemisphere).
///
/// Maximum errors, epsilon being that of T, for T inputs taken as exact: direction() 8 epsilon in each
/// component and in length, its Jacobian 16 epsilon relative; disk() then direction() comes back within
/// 8 epsilon / cos theta_i: what the sum of nearly opposite vectors holds of h.
///
/// Thread safety: immutable; concurrent use is safe.
template <class T>
class HalfVectorChart {
 public:
  static constexpr T largest_theta_i = T(89.9L) * pi<T> / 180;

  /// @param theta_i [rad], clamped to [0, largest_theta_i].
  explicit HalfVectorChart(T theta_i) noexcept {
    theta_i = std::clamp(theta_i, T(0), largest_theta_i);
    const SinCos<T> i = sin_cos(theta_i);
    sin_ = i.sin, cos_ = i.cos;
    scale_ = std::sqrt(T(2)) * (std::sqrt(1 + cos_) + 1) / cos_;
  }

  struct Direction {
    Vec3<T> wo;  ///< unit, wo.z >= 0; > 0 for r < 1
    T jacobian;  ///< d omega_o / (2 r dr dphi), > 0: eq. 3
  };
  struct Point {
    Polar<T> at;  ///< phi in [-pi, pi]; 0 at the pole
    T jacobian;   ///< as in Direction
  };

  /// The outgoing direction of a point of the disk. @param at r in [0, 1].
  Direction direction(Polar<T> at) const noexcept {
    const auto [s, c] = sin_cos(at.phi);
    const Meridian h = meridian(c);
    const T q = at.r * at.r, rest = at.gap * (1 + at.r);
    const T d = scale_ * rest + q / h.m;
    // Eq. 1 as norm sin 2 (theta_max - theta_h), the sine of the difference without cancellation: the
    // distance to the horizon keeps its digits.
    const T below = scale_ * h.m * rest / d;  // m - x
    const T x = q / d, cos_h = h.cos_max + below, sin_h = std::sqrt(x * (1 + cos_h));
    const T sin_left = below * (cos_h + h.cos_max) / (h.sin_max * cos_h + h.cos_max * sin_h);
    const T z = 2 * h.norm * sin_left * (h.cos_max * cos_h + h.sin_max * sin_h);
    const T cos_d = (cos_ + z) / (2 * cos_h);  // wi.h, a sum of positive terms
    const T along = 2 * cos_d * sin_h;
    return {{along * c - sin_, along * s, z}, 4 * cos_d * scale_ / (d * d)};
  }

  /// The inverse of direction(). @param wo a unit vector with wo.z >= 0.
  Point disk(const Vec3<T>& wo) const noexcept {
    // wi + wo, of length 2 wi.h. Near a grazing mirror direction x is a small difference: it is taken
    // from z and y, which hold it to more digits than wo.x does.
    const T sin_o = std::sqrt((1 - wo.z) * (1 + wo.z));
    const T x_mirror = (wo.z - cos_) * (wo.z + cos_) / (sin_ + sin_o) + wo.y * wo.y / (sin_o - wo.x);
    const Vec3<T> h(wo.x < 0 && wo.z < T(0.5) ? x_mirror : sin_ + wo.x, wo.y, cos_ + wo.z);
    const T across2 = h.x * h.x + h.y * h.y, across = std::sqrt(across2), length = std::sqrt(across2 + h.z * h.z);
    const T x = across2 / (length * (length + h.z));
    const auto [m, cos_max, sin_max, norm] = meridian(across > 0 ? h.x / across : T(1));
    // m - x; in the outer half from wo.z, which holds the distance to the horizon to all its digits.
    T below = m - x;
    if (2 * x > m) {
      const T sin2 = std::min(wo.z / norm, T(1)), cos_h = h.z / length;
      const T sin_left = sin2 / std::sqrt(2 * (1 + std::sqrt((1 - sin2) * (1 + sin2))));
      below = sin_left * (sin_max * cos_h + cos_max * (across / length)) / (cos_h + cos_max);
    }
    const T outside = std::max(below / m, T(0)), sum = outside + scale_ * x;
    const T q = std::min(scale_ * x / sum, T(1)), rest = outside / sum;  // 1 - q
    const T d = scale_ * rest + q / m, r = std::sqrt(q);
    return {{r, select(across > 0, fast_atan2(h.y, h.x), T(0)), rest / (1 + r)}, 2 * length * scale_ / (d * d)};
  }

 private:
  struct Meridian {
    T m, cos_max, sin_max, norm;
  };
  /// What eq. 1 gives for the azimuth with cosine c; half angles instead of trigonometry.
  Meridian meridian(T c) const noexcept {
    const T norm = std::sqrt(cos_ * cos_ + sin_ * sin_ * c * c);
    const T cos2 = -sin_ * c / norm, sin2 = cos_ / norm;  // of 2 theta_max
    const T large = (1 + std::abs(cos2)) / 2, small = sin2 * sin2 / (4 * large);
    const T cos_max = std::sqrt(select(cos2 > 0, large, small)), sin_max2 = select(cos2 > 0, small, large);
    return {sin_max2 / (1 + cos_max), cos_max, std::sqrt(sin_max2), norm};
  }

  T sin_, cos_, scale_;
};

}  // namespace gonio
