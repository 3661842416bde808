#pragma once

#include <cmath>
#include <optional>

#include <gonio/fitting/lobes/angles.h>

namespace gonio {

/// Lafortune et al. 1997, eq. 5 (generalised cosine lobe), isotropic: C_x = C_y = -spread and C_z =
/// 1, so that the scale of C is not a second amplitude: (n+2) / (2 pi) max(0, V . wo)^n with V =
/// (-spread wi.x, -spread wi.y, wi.z). spread = 1 is Phong's lobe; spread > 1 leans and grows
/// towards grazing.
///
/// Directional albedo: exactly 1 at normal incidence; less elsewhere for spread <= 1 (the integral
/// of a cosine lobe against cos_o is largest for a lobe along the normal); up to spread^n at
/// grazing beyond.
template <class T>
struct Lafortune {
  T exponent;  ///< n >= 1
  T spread;    ///< |C_x| / C_z, > 0

  template <class S>
  T eval(const Angles<S>& a) const {
    using std::exp;
    using std::log;
    const T dot = spread * T(-a.dot_xy) + T(a.cos_i * a.cos_o);
    if (!(dot > T(0))) return T(0);
    return (exponent + T(2)) / T(2 * pi<S>) * exp(exponent * log(dot));
  }

  /// A cosine-power lobe about V. Empty if wo is not above the horizon.
  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>& wi, T u, T v) const {
    using Vec = glm::vec<3, T>;
    const Vec axis = glm::normalize(Vec(-spread * wi.x, -spread * wi.y, wi.z));
    const T log_cos = std::log1p(-u) / (exponent + T(1));
    const Vec local = polar(std::exp(log_cos), -std::expm1(T(2) * log_cos), v);
    // A frame about the axis, which is on the upper side (Duff et al. 2017, listing 3, sign +).
    const T a = T(-1) / (T(1) + axis.z), b = axis.x * axis.y * a;
    const Vec t1(T(1) + axis.x * axis.x * a, b, -axis.x), t2(b, T(1) + axis.y * axis.y * a, -axis.y);
    const Vec wo = local.x * t1 + local.y * t2 + local.z * axis;
    if (!(wo.z > T(0))) return std::nullopt;
    return wo;
  }

  /// (n+1)/(2 pi) cos^n of the angle to V, in 1/sr.
  template <class S>
  T pdf(const Angles<S>& a) const {
    using std::exp;
    using std::log;
    using std::sqrt;
    const T dot = spread * T(-a.dot_xy) + T(a.cos_i * a.cos_o);
    if (!(dot > T(0))) return T(0);
    const T length = sqrt(spread * spread * T(1 - a.cos_i * a.cos_i) + T(a.cos_i * a.cos_i));
    return (exponent + T(1)) / T(2 * pi<S>) * exp(exponent * log(dot / length));
  }
};

}  // namespace gonio
