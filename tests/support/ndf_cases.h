#pragma once

#include <cmath>

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio::test {

/// Anisotropic GGX: D and G1 of Heitz 2014, eqs. 85, 72 and 87.
struct GgxNdf {
  double ax, ay;
  double operator()(const Vec3<double>& h) const {
    const double q = h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay) + h.z * h.z;
    return 1 / (pi<double> * ax * ay * q * q);
  }
  double g1(const Vec3<double>& k) const {
    const double t = (ax * ax * k.x * k.x + ay * ay * k.y * k.y) / (k.z * k.z);
    return 2 / (1 + std::sqrt(1 + t));
  }
};

/// Anisotropic Beckmann: D and G1 of Heitz 2014, eqs. 84, 68 and 80.
struct BeckmannNdf {
  double ax, ay;
  double operator()(const Vec3<double>& h) const {
    const double z2 = h.z * h.z;
    if (!(z2 > 0)) return 0;
    return std::exp(-(h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay)) / z2) / (pi<double> * ax * ay * z2 * z2);
  }
  double g1(const Vec3<double>& k) const {
    const double a = k.z / std::sqrt(ax * ax * k.x * k.x + ay * ay * k.y * k.y);
    if (!(a < 8)) return 1;
    const double lambda = std::exp(-a * a) / (2 * a * std::sqrt(pi<double>)) - std::erfc(a) / 2;
    return 1 / (1 + lambda);
  }
};

inline Vec3<double> at(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

}  // namespace gonio::test
