#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <gonio/mapping/charts/concentric.h>

namespace gonio {

/// What an isotropic lobe needs to know of a pair of directions. Local frame: the normal is +z.
///
/// sin2_h is kept beside cos_h because 1 - cos_h^2 loses all digits where a narrow lobe lives.
template <class S>
struct Angles {
  S cos_i;   ///< wi.z
  S cos_o;   ///< wo.z
  S cos_h;   ///< z of the half vector
  S sin2_h;  ///< squared sine of the half vector's angle to the normal
  S cos_d;   ///< wi . h = wo . h
  S dot_xy;  ///< sin_i sin_o cos(phi): the tangential part of wi . wo

  /// @pre both are unit vectors with z > 0.
  Angles(const glm::vec<3, S>& wi, const glm::vec<3, S>& wo)
      : cos_i(wi.z), cos_o(wo.z), dot_xy(wi.x * wo.x + wi.y * wo.y) {
    const glm::vec<3, S> sum = wi + wo;
    const S tangent2 = sum.x * sum.x + sum.y * sum.y;
    const S length2 = tangent2 + sum.z * sum.z;
    cos_d = S(0.5) * std::sqrt(length2);
    cos_h = sum.z / std::sqrt(length2);
    sin2_h = tangent2 / length2;
  }
};

/// wi mirrored about the unit half vector h (Walter et al. 2007, eq. 39).
template <class T>
glm::vec<3, T> reflect_about(const glm::vec<3, T>& wi, const glm::vec<3, T>& h) {
  return T(2) * glm::dot(wi, h) * h - wi;
}

/// The unit vector at azimuth 2 pi v whose angle to the pole has this cosine and squared sine.
template <class T>
glm::vec<3, T> polar(T cos_theta, T sin2_theta, T v) {
  const T sin_theta = std::sqrt(sin2_theta > T(0) ? sin2_theta : T(0));
  const T phi = T(2) * pi<T> * v;
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

/// A point of the half of the unit sphere that is seen from a direction whose cosine to the pole is
/// cos_theta, uniform on its visible projection: the components along t1, t2 and the direction itself
/// (Heitz 2018, "Sampling the GGX distribution of visible normals", section 3). u, v in [0, 1).
template <class T>
glm::vec<3, T> visible_point(T cos_theta, T u, T v) {
  const T r = std::sqrt(u), phi = T(2) * pi<T> * v, s = T(0.5) * (T(1) + cos_theta);
  const T p1 = r * std::cos(phi);
  const T p1_rest = std::sqrt(std::fmax(T(0), T(1) - p1 * p1));
  const T p2 = (T(1) - s) * p1_rest + s * r * std::sin(phi);
  return {p1, p2, std::sqrt(std::fmax(T(0), T(1) - p1 * p1 - p2 * p2))};
}

/// A half vector of given tan^2(theta) at azimuth 2 pi v.
template <class T>
glm::vec<3, T> half_vector(T tan2, T v) {
  const T cos2 = T(1) / (T(1) + tan2);
  return polar(std::sqrt(cos2), tan2 * cos2, v);
}

}  // namespace gonio
