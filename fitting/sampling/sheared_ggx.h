#pragma once

#include <cmath>

#include <glm/vec3.hpp>

#include <gonio/fitting/lobes/angles.h>

namespace gonio {

/// A proposal for reflected directions: GGX slopes of two widths, shifted along the plane of
/// incidence, sampled by visible normals. A measured lobe is often wider across the plane of
/// incidence than along it, and off the mirror direction, more so towards grazing, though the
/// material is isotropic.
///
/// Heitz 2018, section 3, with the stretch diag(alpha_x, alpha_y, 1) replaced by the general linear
/// map B^T = [alpha_x 0 shear; 0 alpha_y 0; 0 0 1] of normals: wi is seen as B wi, a normal n of
/// the hemisphere becomes B^T n. The density follows from the Jacobian det(B) / |B^T n|^3 of the
/// normalised map. alpha_x = alpha_y, shear = 0 is Ggx.
///
/// Frame: that of the diagram, wi.y = 0.
template <class T>
struct ShearedGgx {
  T alpha_x;  ///< width along the plane of incidence, > 0
  T alpha_y;  ///< width across it, > 0
  T shear;    ///< mean slope along the azimuth of wi; positive leans towards wi

  /// A unit vector, wo.z >= 0. u, v in [0, 1).
  glm::vec<3, T> sample(const glm::vec<3, T>& wi, T u, T v) const {
    using Vec = glm::vec<3, T>;
    const Vec seen = glm::normalize(Vec(alpha_x * wi.x, T(0), shear * wi.x + wi.z));
    const Vec t1(T(0), T(1), T(0)), t2(-seen.z, T(0), seen.x);  // t2 = seen x t1
    const Vec p = visible_point(seen.z, u, v);
    const Vec n = p.x * t1 + p.y * t2 + p.z * seen;
    const T up = std::fmax(T(1e-12), n.z);
    const Vec h = glm::normalize(Vec(alpha_x * n.x + shear * up, alpha_y * n.y, up));
    Vec wo = glm::normalize(reflect_about(wi, h));
    wo.z = std::fabs(wo.z);
    return wo;
  }

  /// Density of sample() per solid angle of wo [1/sr]. wo above the horizon; directions in any
  /// scalar S.
  template <class S>
  T pdf(const glm::vec<3, S>& wi, const glm::vec<3, S>& wo) const {
    T sum = unfolded_pdf(wi, glm::normalize(wi + wo));
    if (wi.z > wo.z) sum += unfolded_pdf(wi, glm::normalize(wi + glm::vec<3, S>(wo.x, wo.y, -wo.z)));
    return sum;
  }

  /// Before mirroring, for the half vector h (h.z > 0):
  /// 1 / (2 pi det(B) (|B wi| + (B wi)_z) |B^-T h|^4).
  template <class S>
  T unfolded_pdf(const glm::vec<3, S>& wi, const glm::vec<3, S>& h) const {
    using std::sqrt;
    const T x = (T(h.x) - shear * T(h.z)) / alpha_x, y = T(h.y) / alpha_y;
    const T length2 = x * x + y * y + T(h.z * h.z);
    const T seen_x = alpha_x * T(wi.x), seen_z = shear * T(wi.x) + T(wi.z);
    const T seen = sqrt(seen_x * seen_x + seen_z * seen_z) + seen_z;
    return T(1) / (T(2 * pi<S>) * alpha_x * alpha_y * seen * length2 * length2);
  }
};

}  // namespace gonio
