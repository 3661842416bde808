#pragma once

#include <optional>

#include <gonio/fitting/lobes/angles.h>

namespace gonio {

/// Cook-Torrance reflection with the Beckmann distribution and F = 1: D of Walter et al. 2007, eq.
/// 25 (Cook and Torrance 1982, eq. 2); exact Smith Lambda of Heitz 2014, eq. 65 with the
/// height-correlated G2 of eq. 99 in place of Cook and Torrance's V-cavities.
///
/// Directional albedo: at most 1, single scattering.
template <class T>
struct Beckmann {
  T alpha;  ///< root-mean-square slope times sqrt(2), > 0

  template <class S>
  T eval(const Angles<S>& a) const {
    return normal_density(a) / (T(4 * a.cos_i * a.cos_o) * (T(1) + lambda(a.cos_i) + lambda(a.cos_o)));
  }

  /// Half vectors by D cos_h: Walter et al. 2007, eq. 28. Empty if wo is not above the horizon.
  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>& wi, T u, T v) const {
    const glm::vec<3, T> h = half_vector(-alpha * alpha * std::log1p(-u), v);
    const glm::vec<3, T> wo = reflect_about(wi, h);
    if (!(wo.z > T(0)) || !(glm::dot(wi, h) > T(0))) return std::nullopt;
    return wo;
  }

  /// D cos_h / (4 cos_d), in 1/sr.
  template <class S>
  T pdf(const Angles<S>& a) const {
    return normal_density(a) * T(a.cos_h / (4 * a.cos_d));
  }

 private:
  template <class S>
  T normal_density(const Angles<S>& a) const {
    using std::exp;
    const S cos2 = a.cos_h * a.cos_h;
    const T a2 = alpha * alpha;
    return exp(T(-a.sin2_h / cos2) / a2) / (T(pi<S> * cos2 * cos2) * a2);
  }
  template <class S>
  T lambda(S cosine) const {
    using std::erfc;
    using std::exp;
    const S sine = std::sqrt(std::fmax(S(1e-12), S(1) - cosine * cosine));
    const T x = T(cosine / sine) / alpha;
    if (x > T(6)) return T(0);  // below 1e-17
    return exp(-x * x) / (T(2 * std::sqrt(pi<S>)) * x) - T(0.5) * erfc(x);
  }
};

}  // namespace gonio
