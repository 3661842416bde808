#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gonio/mapping/diagram/diagram.h>

namespace gonio::textbook {

/// Formulas as they stand in print, for the stability study alone. None of them is used by the library.

/// M_D by Havran et al. (2003), eqs. 11 and 12: the cubic in X, solved by Cardan's formulas, of its
/// roots the one in the cell. @return the s in [0, 1] of the fraction tau of the cell's mass, or NaN.
template <class T>
T cardan(const RadialCell<T>& c, T tau) noexcept {
  const T x0 = c.r0, x1 = c.r0 + c.h, mass = tau * c.mass(1);  // mass is s (Y^2 - y_j^2)
  const auto inside = [&](T x) { return std::clamp((x - x0) / (x1 - x0), T(0), T(1)); };
  if (c.d0 == c.d1) return inside(std::sqrt(mass / c.d0 + x0 * x0));  // eq. 12
  const T quotient = (x1 - x0) / (c.d0 - c.d1);
  const T b = -T(1.5) * (c.d1 * quotient + x1);
  const T free = T(1.5) * ((mass + c.d1 * x0 * x0) * quotient + x1 * x0 * x0 - T(2) / 3 * x0 * x0 * x0);
  // X = t - b/3 gives t^3 + p t + q = 0.
  const T p = -b * b / 3, q = 2 * b * b * b / 27 + free;
  const T discriminant = q * q / 4 + p * p * p / 27;
  if (discriminant > 0) {
    const T root = std::sqrt(discriminant);
    return inside(std::cbrt(-q / 2 + root) + std::cbrt(-q / 2 - root) - b / 3);
  }
  const T radius = 2 * std::sqrt(-p / 3), angle = std::acos(std::clamp(3 * q / (p * radius), T(-1), T(1)));
  T best = 0, distance = -1;
  for (int k = 0; k < 3; ++k) {
    const T x = radius * std::cos((angle - 2 * pi<T> * static_cast<T>(k)) / 3) - b / 3;
    const T away = std::abs(x - (x0 + x1) / 2);
    if (distance < 0 || away < distance) best = x, distance = away;
  }
  return inside(best);
}

/// M_C by eq. 24: the root of a e^2 + b e + c = 0 as (-b + sqrt(D)) / 2a. @param m0,m1 the masses of the two
/// meridians, @param fraction of the cell's mass. @return e in [0, 1], or NaN.
template <class T>
T quadratic(T m0, T m1, T fraction) noexcept {
  const T a = (m1 - m0) / 2, b = m0, c = -fraction * (m0 + m1) / 2;
  if (a == 0) return -c / b;
  return std::clamp((-b + std::sqrt(b * b - 4 * a * c)) / (2 * a), T(0), T(1));
}

/// M_E by eqs. 2 and 3, and back by the angle to the normal.
template <class T>
Vec3<T> direction(Polar<T> p) noexcept {
  const T theta = std::acos(1 - p.r * p.r);
  return {std::sin(theta) * std::cos(p.phi), std::sin(theta) * std::sin(p.phi), std::cos(theta)};
}
template <class T>
Polar<T> polar(const Vec3<T>& w) noexcept {
  const T theta = std::acos(std::min(w.z, T(1)));  // the dot product with the normal
  return {std::min(std::sqrt(1 - std::cos(theta)), T(1)), std::atan2(w.y, w.x)};
}

/// A diagram whose arrays can be read: lines, densities, and cumulative masses as eqs. 13 to 22 ask.
struct Arrays {
  explicit Arrays(const DiagramGrid& grid);

  float at(std::size_t i, std::size_t j) const { return density[i * r.size() + j]; }
  float below(std::size_t i, std::size_t j) const { return cumulative[i * r.size() + j]; }

  /// The maps M_C and M_D, with the root formulas given: the same search and the same arrays as the
  /// library's, so that a difference is the formula's.
  template <class Quadratic, class Cubic>
  Polar<float> map(float u, float v, const Quadratic& solve_phi, const Cubic& solve_r) const {
    const float target = u * cumulative_phi.back();
    const std::size_t i =
        static_cast<std::size_t>(find_cell(cumulative_phi.data(), static_cast<int>(phi.size()), target));
    const std::size_t n = r.size();
    const float m0 = below(i, n - 1), m1 = below(i + 1, n - 1);
    const float a = solve_phi(m0, m1, (target - cumulative_phi[i]) / (cumulative_phi[i + 1] - cumulative_phi[i]));
    const float b = 1 - a;
    const auto blend = [&](std::size_t j) { return b * below(i, j) + a * below(i + 1, j); };
    const float mass = v * blend(n - 1);
    std::size_t j = 0;
    while (j + 2 < n && blend(j + 1) < mass) ++j;
    const RadialCell<float> cell{r[j], r[j + 1] - r[j], b * at(i, j) + a * at(i + 1, j),
                                 b * at(i, j + 1) + a * at(i + 1, j + 1)};
    const float tau = (mass - blend(j)) / cell.mass(1);
    return {cell.r0 + solve_r(cell, tau) * cell.h, phi[i] + a * (phi[i + 1] - phi[i])};
  }

  std::vector<float> phi, r, density, cumulative, cumulative_phi;
};

/// Inverse-CDF sampling of a table of constant cells by a summed-area table in T: marginal, conditional
/// and cell mass are differences of its corners.
template <class T>
struct ConstantCells {
  explicit ConstantCells(const Arrays& arrays);

  /// (u, v) in [0, 1]^2 to the disk.
  Polar<float> map(T u, T v) const;
  /// The pdf [1/sr] of the cell that holds the point, from the four corners.
  T pdf(Polar<float> at) const;

  std::vector<T> phi, r, sums;
};

}  // namespace gonio::textbook
