#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>

#include <gonio/brdf/ndf/image/solid_angle.h>

namespace gonio {
namespace {

constexpr double rounding = 1.1102230246251565e-16;  // 2^-53

// The four-corner difference of the closed form is off by at most this (docs/guide/ndf.md).
constexpr double closed_form_error = 48 * rounding;
constexpr double closed_form_relative = 1e-13;

/// 1 - x^2 - y^2 with a relative error of a few roundings: next to the circle the rounded squares
/// differ from 1 by what is wanted, so that their errors are taken along.
double one_minus_squares(double x, double y) noexcept {
  if (x < y) std::swap(x, y);
  const double xx = x * x, yy = y * y;
  return ((1 - xx) - yy) - (std::fma(x, x, -xx) + std::fma(y, y, -yy));
}

double primitive(double x, double y) noexcept {
  const double s = std::sqrt(std::max(one_minus_squares(x, y), 0.0));
  return x * std::atan2(y, s) + y * std::atan2(x, s) - std::atan2(x * y, s);
}

/// Bernstein's parameter of the ellipse with foci 0 and `length` that passes through (x, y).
double bernstein(double x, double y, double length) noexcept {
  const double c = (std::hypot(x, y) + std::hypot(x - length, y)) / length;
  return c + std::sqrt(std::max(c * c - 1, 0.0));
}

/// Where n-point Gauss quadrature of a function that is analytic within the ellipse rho, and there at
/// most 16 times its mean, has a relative error below 1e-14: (64/15) 8 rho^-2n / (1 - rho^-2)
/// (Trefethen 2013, theorem 19.3).
constexpr double enough_for_4 = 88, enough_for_7 = 12.8, enough_for_15 = 3.3;

/// The integral of f(t) over [start, start + length], f singular at t = `real` beyond it and at
/// +-i `imaginary`.
template <class Function>
double integrate(const Function& f, double start, double length, double real, double imaginary,
                 int depth = 0) noexcept {
  using boost::math::quadrature::gauss;
  if (!(length > 0)) return 0;
  const double rho = std::min(bernstein(real - start, 0, length), bernstein(-start, imaginary, length));
  // Not as start and end: a short interval far from 0 would lose its length.
  const auto shifted = [&](double tau) { return f(start + tau); };
  if (rho > enough_for_4) return gauss<double, 4>::integrate(shifted, 0.0, length);
  if (rho > enough_for_7) return gauss<double, 7>::integrate(shifted, 0.0, length);
  if (rho > enough_for_15 || depth == 60) return gauss<double, 15>::integrate(shifted, 0.0, length);
  const double half = length / 2;
  return integrate(f, start, half, real, imaginary, depth + 1) +
         integrate(f, start + half, half, real, imaginary, depth + 1);
}

/// Columns of the rectangle, each in closed form, integrated over x by Gauss quadrature. With
/// x = r - t^2, r where a side meets the circle, the integrand is analytic up to the circle.
/// All differences are taken of numbers that are given, or written as quotients of positive sums.
double by_quadrature(double x0, double x1, double y0, double y1) noexcept {
  const double r0 = std::sqrt((1 - y0) * (1 + y0));  // the circle at y0, r0 > x0
  const double r1 = std::sqrt((1 - y1) * (1 + y1));  // and at y1
  const double strip = (y1 - y0) * (y1 + y0);        // y1^2 - y0^2 = r0^2 - r1^2
  double sum = 0;
  const double inside = one_minus_squares(x0, y1);
  if (inside > 0) {  // columns that end at y1
    const double corner = one_minus_squares(x1, y1);
    const double near = corner > 0 ? corner / (r1 + x1) : 0;  // r1 - x1
    const double width = corner > 0 ? x1 - x0 : inside / (r1 + x0);
    const double start = std::sqrt(near), end = std::sqrt(near + width);
    const auto columns = [&](double t) {
      const double s1 = t * std::sqrt(2 * r1 - t * t), s0 = std::sqrt(s1 * s1 + strip);
      // atan2(y1, s1) - atan2(y0, s0)
      const double sine = (s0 * s0 + y0 * y0) * strip / (y1 * s0 + y0 * s1);
      return 2 * t * std::atan2(sine, s0 * s1 + y0 * y1);
    };
    sum += integrate(columns, start, width / (start + end), std::sqrt(2 * r1), std::sqrt(strip / (r0 + r1)));
  }
  if (one_minus_squares(x1, y1) < 0) {  // columns that end at the circle
    const double corner = one_minus_squares(x1, y0);
    const double near = corner > 0 ? corner / (r0 + x1) : 0;  // r0 - x1
    const double far = inside > 0 ? strip / (r0 + r1) : one_minus_squares(x0, y0) / (r0 + x0);
    const double width = corner > 0 && !(inside > 0) ? x1 - x0 : far - near;
    const double start = std::sqrt(near), end = std::sqrt(near + width);
    const auto columns = [&](double t) { return 2 * t * std::atan2(t * std::sqrt(2 * r0 - t * t), y0); };
    sum += integrate(columns, start, width / (start + end), std::sqrt(2 * r0), std::sqrt(y0 * y0 / (1 + r0)));
  }
  return sum;
}

/// Splits the rectangle at the axes and hands its parts, mirrored to the first quadrant and cut to
/// [0, 1], to f.
template <class Function>
void for_each_quadrant(double x0, double x1, double y0, double y1, const Function& f) noexcept {
  for (const double sx : {1.0, -1.0}) {
    const double left = std::max(sx > 0 ? x0 : -x1, 0.0), right = std::min(sx > 0 ? x1 : -x0, 1.0);
    if (!(left < right)) continue;
    for (const double sy : {1.0, -1.0}) {
      const double low = std::max(sy > 0 ? y0 : -y1, 0.0), high = std::min(sy > 0 ? y1 : -y0, 1.0);
      if (low < high && one_minus_squares(left, low) > 0) f(sx, sy, left, right, low, high);
    }
  }
}

/// The integral of z dy along x = const from 0 to y, times 2.
double half_disk(double x, double y) noexcept {
  const double s = std::sqrt(std::max(one_minus_squares(x, y), 0.0));
  return y * s + (1 - x) * (1 + x) * std::atan2(y, s);
}

/// Area of [0, x] x [0, y] within the disk.
double area(double x, double y) noexcept {
  if (one_minus_squares(x, y) >= 0) return x * y;
  return (x * std::sqrt((1 - x) * (1 + x)) + y * std::sqrt((1 - y) * (1 + y)) + std::asin(x) + std::asin(y) -
          pi<double> / 2) /
         2;
}

template <class Function>
double corners(const Function& f, double x0, double x1, double y0, double y1) noexcept {
  return (f(x1, y1) - f(x0, y1)) - (f(x1, y0) - f(x0, y0));
}

double solid_angle(double x0, double x1, double y0, double y1) noexcept {
  for (const double coordinate : {x0, x1, y0, y1})
    if (std::isnan(coordinate)) return coordinate;
  double sum = 0;
  for_each_quadrant(x0, x1, y0, y1, [&](double, double, double left, double right, double low, double high) {
    constexpr double enough = closed_form_error / closed_form_relative;
    if ((right - left) * (high - low) > enough) {
      const double closed = corners(primitive, left, right, low, high);
      if (closed > enough) {
        sum += closed;
        return;
      }
    }
    // Columns across the nearer side of the circle: there it is flat, and singularities stay away.
    const bool swap = left + right > low + high;
    sum += swap ? by_quadrature(low, high, left, right) : by_quadrature(left, right, low, high);
  });
  return sum;
}

}  // namespace

template <class T>
T orthographic_solid_angle(T x0, T x1, T y0, T y1) noexcept {
  // Float through double: one rounding, where float itself has none to spare for a small pixel.
  return static_cast<T>(solid_angle(x0, x1, y0, y1));
}

template float orthographic_solid_angle(float, float, float, float) noexcept;
template double orthographic_solid_angle(double, double, double, double) noexcept;

Vec3<double> orthographic_normal_integral(double x0, double x1, double y0, double y1) noexcept {
  Vec3<double> sum(0);
  for_each_quadrant(x0, x1, y0, y1, [&](double sx, double sy, double left, double right, double low, double high) {
    sum.x -= sx * corners(half_disk, left, right, low, high) / 2;
    sum.y -= sy * corners(half_disk, low, high, left, right) / 2;
    sum.z +=
        one_minus_squares(right, high) >= 0 ? (right - left) * (high - low) : corners(area, left, right, low, high);
  });
  return sum;
}

}  // namespace gonio
