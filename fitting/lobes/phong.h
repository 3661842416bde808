#pragma once

#include <cmath>
#include <optional>

#include <gonio/fitting/lobes/angles.h>

namespace gonio {

/// Half vector distributed as (n+1)/(2 pi) cos^n(theta_h) per solid angle.
template <class T>
glm::vec<3, T> cosine_power_half_vector(const T& exponent, T u, T v) {
  // 1 - cos^2 by expm1: exact for the large exponents of narrow lobes.
  const T log_cos = std::log1p(-u) / (exponent + T(1));
  return polar(std::exp(log_cos), -std::expm1(T(2) * log_cos), v);
}

/// Blinn 1977 in the half vector, normalised after Giesen 2009, "Phong and Blinn-Phong
/// normalization factors": (n+2)(n+4) / (8 pi (2^(-n/2) + n)) cos^n(theta_h).
///
/// Directional albedo: exactly 1 at normal incidence, less elsewhere.
template <class T>
struct BlinnPhong {
  T exponent;  ///< n >= 1

  template <class S>
  T eval(const Angles<S>& a) const {
    using std::exp;
    return (exponent + T(2)) * (exponent + T(4)) * exp(exponent * T(log_cos_h(a))) /
           (T(8 * pi<S>) * (exp(exponent * T(-0.5 * std::log(2.0))) + exponent));
  }

  /// Empty if wo is not above the horizon.
  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>& wi, T u, T v) const {
    const glm::vec<3, T> h = cosine_power_half_vector(exponent, u, v);
    const glm::vec<3, T> wo = reflect_about(wi, h);
    if (!(wo.z > T(0)) || !(glm::dot(wi, h) > T(0))) return std::nullopt;
    return wo;
  }

  /// (n+1) cos^n(theta_h) / (8 pi cos_d), in 1/sr.
  template <class S>
  T pdf(const Angles<S>& a) const {
    using std::exp;
    return (exponent + T(1)) * exp(exponent * T(log_cos_h(a))) / T(8 * pi<S> * a.cos_d);
  }

  template <class S>
  static S log_cos_h(const Angles<S>& a) {
    return S(0.5) * std::log1p(-a.sin2_h);
  }
};

/// Ashikhmin and Shirley 2000, eq. 4 with n_u = n_v = n and F = 1:
/// (n+1)/(8 pi) cos^n(theta_h) / (cos_d max(cos_i, cos_o)).
///
/// Directional albedo: at most 1, since f_r cos_o <= pdf.
template <class T>
struct AshikhminShirley {
  T exponent;  ///< n >= 1

  template <class S>
  T eval(const Angles<S>& a) const {
    return pdf(a) / T(std::fmax(a.cos_i, a.cos_o));
  }

  /// Empty if wo is not above the horizon.
  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>& wi, T u, T v) const {
    return BlinnPhong<T>{exponent}.sample(wi, u, v);
  }

  /// Ashikhmin and Shirley 2000, eq. 8, in 1/sr.
  template <class S>
  T pdf(const Angles<S>& a) const {
    return BlinnPhong<T>{exponent}.pdf(a);
  }
};

}  // namespace gonio
