#pragma once

#include <optional>

#include <gonio/fitting/lobes/angles.h>

namespace gonio {

/// Trowbridge-Reitz / GGX with height-correlated Smith masking-shadowing and F = 1:
/// D of Walter et al. 2007, eq. 33; G2 of Heitz 2014, eq. 99.
///
/// Directional albedo: at most 1 (what single scattering loses is not put back); 1 in the limit
/// alpha -> 0.
template <class T>
struct Ggx {
  T alpha;  ///< width of the slope distribution, > 0

  template <class S>
  T eval(const Angles<S>& a) const {
    const T a2 = alpha * alpha;
    // G2 / (4 cos_i cos_o), multiplied out so that nothing is divided by a vanishing cosine.
    return normal_density(a) * T(0.5) / (T(a.cos_o) * root(a2, a.cos_i) + T(a.cos_i) * root(a2, a.cos_o));
  }

  /// Visible normals: Heitz 2018, "Sampling the GGX distribution of visible normals", section 3.
  /// Empty if the reflected direction is not above the horizon.
  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>& wi, T u, T v) const {
    using Vec = glm::vec<3, T>;
    const Vec stretched = glm::normalize(Vec(alpha * wi.x, alpha * wi.y, wi.z));
    const T length2 = stretched.x * stretched.x + stretched.y * stretched.y;
    const Vec t1 = length2 > T(0) ? Vec(-stretched.y, stretched.x, T(0)) / std::sqrt(length2) : Vec(T(1), T(0), T(0));
    const Vec t2 = glm::cross(stretched, t1);
    const Vec p = visible_point(stretched.z, u, v);
    const Vec n = p.x * t1 + p.y * t2 + p.z * stretched;
    const Vec h = glm::normalize(Vec(alpha * n.x, alpha * n.y, std::fmax(T(1e-12), n.z)));
    const Vec wo = reflect_about(wi, h);
    if (!(wo.z > T(0))) return std::nullopt;
    return wo;
  }

  /// Density of sample() per solid angle of wo: G1(wi) D(h) / (4 cos_i) (Heitz 2018, eq. 17).
  /// Integrates to 1 minus the share of draws that are empty.
  template <class S>
  T pdf(const Angles<S>& a) const {
    return normal_density(a) * T(0.5) / (T(a.cos_i) + root(alpha * alpha, a.cos_i));
  }

 private:
  template <class S>
  T normal_density(const Angles<S>& a) const {
    const T a2 = alpha * alpha;
    const T d = a2 * T(a.cos_h * a.cos_h) + T(a.sin2_h);
    return a2 / (T(pi<S>) * d * d);
  }
  template <class S>
  static T root(const T& a2, S cosine) {
    using std::sqrt;
    return sqrt(a2 + (T(1) - a2) * T(cosine * cosine));
  }
};

}  // namespace gonio
