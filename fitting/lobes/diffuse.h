#pragma once

#include <cmath>
#include <optional>

#include <gonio/fitting/lobes/angles.h>

/// Diffuse lobes with albedo 1. A lobe is a small value with the parameters as members; eval()
/// takes its parameters in any scalar T (float, double, ceres::Jet) and the angles in S. All of
/// them propose directions by the cosine.
namespace gonio {

/// Cosine-distributed direction (Malley's method). u, v in [0, 1).
template <class T>
glm::vec<3, T> cosine_sample(T u, T v) {
  return polar(std::sqrt(T(1) - u), u, v);
}

/// cos(theta_o) / pi, in 1/sr.
template <class T>
T cosine_pdf(T cos_o) {
  return cos_o > T(0) ? cos_o / pi<T> : T(0);
}

/// Lambert 1760: f_r = 1 / pi. Directional albedo: exactly 1.
template <class T>
struct Lambert {
  template <class S>
  T eval(const Angles<S>&) const {
    return T(1 / pi<S>);
  }

  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>&, T u, T v) const { return cosine_sample(u, v); }
  template <class S>
  T pdf(const Angles<S>& a) const {
    return T(cosine_pdf(a.cos_o));
  }
};

/// Oren and Nayar 1994, eq. 30 (the "qualitative model", without interreflection).
///
/// Directional albedo: A + B/pi (sin t (t - sin t cos t) + 2/3 tan t (1 - sin^3 t)), t = theta_i
/// (integral of eq. 30 worked out here); it lies in [0.6, 1] for sigma in [0, pi/2].
template <class T>
struct OrenNayar {
  T sigma;  ///< standard deviation of the facets' slope angle, radians

  template <class S>
  T eval(const Angles<S>& a) const {
    const T s2 = sigma * sigma;
    const T weight_a = T(1) - T(0.5) * s2 / (s2 + T(0.33));
    const T weight_b = T(0.45) * s2 / (s2 + T(0.09));
    // max(0, cos(phi)) sin(alpha) tan(beta), alpha and beta the larger and the smaller angle.
    const S back = a.dot_xy > S(0) ? a.dot_xy / std::fmax(a.cos_i, a.cos_o) : S(0);
    return (weight_a + weight_b * T(back)) * T(1 / pi<S>);
  }

  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>&, T u, T v) const { return cosine_sample(u, v); }
  template <class S>
  T pdf(const Angles<S>& a) const {
    return T(cosine_pdf(a.cos_o));
  }
};

/// Burley 2012, section 5.3: Disney diffuse.
///
/// Not energy conserving: the directional albedo for albedo 1 stays below 1.2 up to 70 degrees and
/// reaches 2.5 at grazing for roughness 1 (a property of the model, kept as published).
template <class T>
struct Burley {
  T roughness;  ///< perceptual roughness in [0, 1]

  template <class S>
  T eval(const Angles<S>& a) const {
    const T grazing = T(2 * a.cos_d * a.cos_d) * roughness - T(0.5);  // F_D90 - 1
    return (T(1) + grazing * T(fifth(1 - a.cos_i))) * (T(1) + grazing * T(fifth(1 - a.cos_o))) * T(1 / pi<S>);
  }

  std::optional<glm::vec<3, T>> sample(const glm::vec<3, T>&, T u, T v) const { return cosine_sample(u, v); }
  template <class S>
  T pdf(const Angles<S>& a) const {
    return T(cosine_pdf(a.cos_o));
  }

 private:
  template <class S>
  static S fifth(S x) {
    return x * x * x * x * x;
  }
};

}  // namespace gonio
