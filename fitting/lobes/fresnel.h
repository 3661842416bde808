#pragma once

#include <cmath>

/// Fresnel reflectance as a function of cos_d = wi . h in [0, 1].
namespace gonio {

/// Schlick 1994, eq. 15, with the reflectance at grazing left free:
/// F = F0 + (F90 - F0) (1 - cos_d)^5. F90 = 1 is Schlick's own formula.
/// Linear in both, so that the amplitude of a fitted lobe needs no further parameter.
template <class T, class S>
T schlick(const T& f0, const T& f90, S cos_d) {
  const S x = S(1) - cos_d;
  const S weight = x * x * x * x * x;
  return f0 * T(S(1) - weight) + f90 * T(weight);
}

/// Exact unpolarised reflectance of a conductor with index eta + i k against vacuum (Born and Wolf,
/// Principles of Optics, 14.2; in the real form of Lagarde 2013, "Memo on Fresnel equations").
/// eta > 0, k >= 0.
template <class T, class S>
T conductor(const T& eta, const T& k, S cos_d) {
  using std::sqrt;
  const S cos2 = cos_d * cos_d, sin2 = S(1) - cos2;
  const T eta2 = eta * eta, k2 = k * k;
  const T t0 = eta2 - k2 - T(sin2);
  const T a2_plus_b2 = sqrt(t0 * t0 + T(4) * eta2 * k2);
  const T t1 = a2_plus_b2 + T(cos2);
  T half = T(0.5) * (a2_plus_b2 + t0);
  if (half < T(1e-12)) half = T(1e-12);  // a dielectric at grazing: the root's slope is infinite
  const T t2 = T(2 * cos_d) * sqrt(half);
  const T rs = (t1 - t2) / (t1 + t2);
  const T t3 = T(cos2) * a2_plus_b2 + T(sin2 * sin2);
  const T t4 = t2 * T(sin2);
  return T(0.5) * (rs + rs * (t3 - t4) / (t3 + t4));
}

}  // namespace gonio
