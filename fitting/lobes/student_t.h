#pragma once

#include <optional>

#include <gonio/fitting/lobes/angles.h>

namespace gonio {

/// Microfacets with Student-t slopes and a free tail, F = 1: D of Ribardiere et al. 2017, "STD:
/// Student's t-Distribution of Slopes for Microfacet Based BSDFs", eq. 10. It is GTR (Burley 2012,
/// appendix B) with the width scaled so that gamma -> infinity is Beckmann; gamma = 2 is GGX;
/// smaller is heavier.
///
/// Masking-shadowing is the exact Smith term of these slopes (Lambda of Heitz 2014, eq. 27, the
/// tail probability by an 8-point Gauss-Legendre rule), height-correlated. So the directional
/// albedo is at most 1, single scattering.
template <class T>
struct StudentT {
  T alpha;  ///< width, > 0
  T gamma;  ///< tail exponent, > 1.5

  template <class S>
  T eval(const Angles<S>& a) const {
    return normal_density(a) / (T(4 * a.cos_i * a.cos_o) * (T(1) + lambda(a.cos_i) + lambda(a.cos_o)));
  }

  /// Half vectors by D cos_h (inverting the integral of eq. 10). Empty if wo is not above the
  /// horizon.
  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>& wi, T u, T v) const {
    const T b = (gamma - T(1)) * alpha * alpha;
    const glm::vec<3, T> h = half_vector(b * std::expm1(-std::log1p(-u) / (gamma - T(1))), v);
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
  // (gamma-1)^gamma alpha^(2 gamma - 2) / (pi cos^4 ((gamma-1) alpha^2 + tan^2)^gamma), with the
  // powers taken of a ratio so that nothing overflows.
  template <class S>
  T normal_density(const Angles<S>& a) const {
    using std::exp;
    using std::log;
    const S cos2 = a.cos_h * a.cos_h;
    const T b = (gamma - T(1)) * alpha * alpha;
    return exp(-gamma * log(T(1) + T(a.sin2_h / cos2) / b)) / (T(pi<S> * cos2 * cos2) * alpha * alpha);
  }

  // The slope along one axis has density C (1 + x^2/b)^-q, b = (gamma-1) alpha^2, q = gamma - 1/2.
  // Lambda(c) = 1/c int_c^inf x P(x) dx - int_c^inf P(x) dx at c = cot(theta). With x = sqrt(b)
  // tan(t) the second integral, and the normalisation 1/C, are integrals of cos^(2q-2)(t).
  template <class S>
  T lambda(S cosine) const {
    using std::atan;
    using std::exp;
    using std::log;
    using std::sqrt;
    const S sine = std::sqrt(std::fmax(S(1e-12), S(1) - cosine * cosine));
    const S c = cosine / sine;
    const T b = (gamma - T(1)) * alpha * alpha;
    const T q = gamma - T(0.5);
    const T t0 = atan(T(c) / sqrt(b));
    const T below = power_integral(T(0), t0, q), above = power_integral(t0, T(pi<S> / 2), q);
    const T first = sqrt(b) * exp((T(1) - q) * log(T(1) + T(c * c) / b)) / (T(2 * c) * (q - T(1)));
    const T result = (first - above) / (T(2) * (below + above));
    return result > T(0) ? result : T(0);
  }

  // int_from^to cos^(2q-2)(t) dt, 8-point Gauss-Legendre (Abramowitz and Stegun, table 25.4).
  static T power_integral(const T& from, const T& to, const T& q) {
    using std::cos;
    using std::exp;
    using std::log;
    constexpr double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    constexpr double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    const T middle = T(0.5) * (from + to), half = T(0.5) * (to - from), p = T(2) * q - T(2);
    T sum(0);
    for (int i = 0; i < 4; ++i) {
      sum += T(weight[i]) *
             (exp(p * log(cos(middle - T(node[i]) * half))) + exp(p * log(cos(middle + T(node[i]) * half))));
    }
    return sum * half;
  }
};

}  // namespace gonio
