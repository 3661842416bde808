#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <random>
#include <vector>

#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <gonio/brdf/ndf/image/solid_angle.h>

namespace gonio {
namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;  // 113 bits

constexpr double double_error = 1e-13, float_error = 6e-8;  // what the header states

double relative(double found, const Quad& expected) {
  if (expected == 0) return std::abs(found);
  return std::abs(static_cast<double>((Quad(found) - expected) / expected));
}

/// Columns over x by tanh-sinh quadrature in 113 bits, which does not mind the roots at the ends.
Quad by_quadrature(double x0, double x1, double y0, double y1) {
  // Folded to the quadrant: the grids below have no pixel across an axis, or are split by the caller.
  const Quad a = std::min(std::abs(x0), std::abs(x1)), b = std::max(std::abs(x0), std::abs(x1));
  const Quad c = std::min(std::abs(y0), std::abs(y1)), d = std::max(std::abs(y0), std::abs(y1));
  static boost::math::quadrature::tanh_sinh<Quad> rule(12);
  const auto circle = [](const Quad& y) { return y < 1 ? Quad(sqrt((1 - y) * (1 + y))) : Quad(0); };
  const auto angle = [](const Quad& y, const Quad& x) {
    const Quad s2 = 1 - x * x - y * y;
    return s2 > 0 ? Quad(atan(y / sqrt(s2))) : Quad(boost::math::constants::half_pi<Quad>());
  };
  const auto column = [&](const Quad& x) { return Quad(angle(d, x) - angle(c, x)); };
  const Quad cut = std::clamp(circle(d), a, b), end = std::clamp(circle(c), a, b);
  const Quad tolerance = 1e-18;
  Quad sum = 0;
  if (a < cut) sum += rule.integrate(column, a, cut, tolerance);
  if (cut < end) sum += rule.integrate(column, cut, end, tolerance);
  return sum;
}

Quad primitive(const Quad& x, const Quad& y) {
  const Quad s2 = 1 - x * x - y * y;
  const Quad s = s2 > 0 ? Quad(sqrt(s2)) : Quad(0);
  return x * atan2(y, s) + y * atan2(x, s) - atan2(x * y, s);
}

/// Four corners of the closed form in 113 bits.
Quad closed_form(double x0, double x1, double y0, double y1) {
  const auto clamp = [](double v) { return Quad(std::clamp(v, -1.0, 1.0)); };
  const Quad a = clamp(x0), b = clamp(x1), c = clamp(y0), d = clamp(y1);
  return primitive(b, d) - primitive(a, d) - primitive(b, c) + primitive(a, c);
}

double line(int k, int n, double from) { return from + (1 - from) * k / n; }

/// Of all pixels of the n x n grid over [from, 1]^2.
double grid_sum(int n, double from) {
  const auto rows = [=](int first) {
    long double sum = 0;
    for (int j = first; j < n; j += 2)
      for (int i = 0; i < n; ++i)
        sum += orthographic_solid_angle(line(i, n, from), line(i + 1, n, from), line(j, n, from), line(j + 1, n, from));
    return sum;
  };
  auto odd = std::async(std::launch::async, rows, 1);
  const long double even = rows(0);
  return static_cast<double>(even + odd.get());
}

// With 10^8 pixels and the printed formula the author reached 1.5536 for the quarter, pi/2.
TEST(SolidAngle, GridsSumToTheHemisphere) {
  for (const int n : {1, 2, 3, 4, 5, 8, 16, 31, 32, 64, 100, 128, 256, 512, 1000, 1024, 2048, 4096}) {
    EXPECT_NEAR(grid_sum(n, 0), pi<double> / 2, 1e-12) << n << " x " << n << " over the quarter";
    if (n != 2048) {  // those pixels are in the quarter of 4096 too
      EXPECT_NEAR(grid_sum(n, -1), 2 * pi<double>, 1e-12) << n << " x " << n << " over the disk";
    }
  }
}

TEST(SolidAngle, EveryPixelAgreesWithQuadrature) {
  for (const int n : {1, 2, 7, 16}) {
    double worst = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i <= j; ++i) {
        const double x0 = line(i, n, 0), x1 = line(i + 1, n, 0), y0 = line(j, n, 0), y1 = line(j + 1, n, 0);
        const Quad exact = by_quadrature(x0, x1, y0, y1);
        worst = std::max({worst, relative(orthographic_solid_angle(x0, x1, y0, y1), exact),
                          relative(orthographic_solid_angle(y0, y1, x0, x1), exact)});
        if (exact > 0) {
          EXPECT_LT(abs(closed_form(x0, x1, y0, y1) / exact - 1), 1e-15) << i << " " << j;
        }
      }
    EXPECT_LT(worst, double_error) << n;
  }
}

// The closed form in 113 bits, which the test above checks against quadrature, for more pixels.
TEST(SolidAngle, EveryPixelOfLargerGrids) {
  for (const int n : {24, 64}) {
    double worst = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i <= j; ++i) {
        const double x0 = line(i, n, 0), x1 = line(i + 1, n, 0), y0 = line(j, n, 0), y1 = line(j + 1, n, 0);
        if (x0 * x0 + y0 * y0 >= 1) continue;
        worst = std::max(worst, relative(orthographic_solid_angle(x0, x1, y0, y1), closed_form(x0, x1, y0, y1)));
      }
    EXPECT_LT(worst, double_error) << n;
  }
  double worst = 0;  // along the circle of a fine grid, and at random
  constexpr int n = 4096;
  std::mt19937 engine(5);
  for (int k = 0; k < 3000; ++k) {
    int i = static_cast<int>(engine() % n), j = static_cast<int>(engine() % n);
    if (k % 2 == 0) j = static_cast<int>(std::sqrt(1.0 * n * n - 1.0 * i * i));
    const double x0 = line(i, n, 0), x1 = line(i + 1, n, 0), y0 = line(j, n, 0), y1 = line(j + 1, n, 0);
    if (x0 * x0 + y0 * y0 >= 1) continue;
    worst = std::max(worst, relative(orthographic_solid_angle(x0, x1, y0, y1), closed_form(x0, x1, y0, y1)));
  }
  EXPECT_LT(worst, double_error);
}

// Rectangles of all shapes down to 1e-6, where four corners in double would have no digit left.
TEST(SolidAngle, SmallAndThinRectangles) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> uniform;
  double worst = 0, worst_corners = 0;
  for (int k = 0; k < 4000; ++k) {
    const double radius = k % 3 == 0 ? 1 - std::pow(10, -8 * uniform(engine)) : std::sqrt(uniform(engine));
    const double phi = 2 * pi<double> * uniform(engine);
    const double w = std::pow(10, -6 * uniform(engine)), h = k % 2 ? w : std::pow(10, -6 * uniform(engine));
    const double x0 = radius * std::cos(phi) - w * uniform(engine), x1 = x0 + w;
    const double y0 = radius * std::sin(phi) - h * uniform(engine), y1 = y0 + h;
    const Quad exact = closed_form(x0, x1, y0, y1);
    if (!(exact > 1e-17)) continue;
    worst = std::max(worst, relative(orthographic_solid_angle(x0, x1, y0, y1), exact));
    const auto corner = [](double x, double y) {
      x = std::clamp(x, -1.0, 1.0), y = std::clamp(y, -1.0, 1.0);
      const double s = std::sqrt(std::max(1 - x * x - y * y, 0.0));
      return x * std::atan2(y, s) + y * std::atan2(x, s) - std::atan2(x * y, s);
    };
    const double closed = corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
    worst_corners = std::max(worst_corners, relative(closed, exact));
  }
  EXPECT_LT(worst, double_error);
  EXPECT_GT(worst_corners, 1e-5);  // what this is for
}

TEST(SolidAngle, FloatIsRoundedOnce) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform;
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    const float w = std::pow(10.0f, -4 * uniform(engine));
    const float x0 = 1.5f * uniform(engine) - 0.75f, x1 = x0 + w, y0 = 1.5f * uniform(engine) - 0.75f, y1 = y0 + w;
    if (!(x1 > x0 && y1 > y0)) continue;
    const Quad exact = closed_form(x0, x1, y0, y1);
    if (exact > 1e-17)
      worst = std::max(worst, relative(static_cast<double>(orthographic_solid_angle(x0, x1, y0, y1)), exact));
  }
  EXPECT_LT(worst, float_error);
  EXPECT_GT(worst, 1e-9);
}

// The closed form alone stays within the bound by which it is chosen, 48 * 2^-53.
TEST(SolidAngle, BoundOfTheClosedForm) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform;
  double worst = 0;
  for (int k = 0; k < 3000; ++k) {
    double x = uniform(engine), y = uniform(engine);
    if (k % 2) y = std::sqrt(std::max(0.0, 1 - x * x)) * (1 - std::pow(10, -12 * uniform(engine)));
    if (x * x + y * y > 1) continue;
    // One corner with both others on the axes, where the primitive is 0.
    const double found = orthographic_solid_angle(0.0, x, 0.0, y);
    worst = std::max(worst, std::abs(static_cast<double>(Quad(found) - primitive(x, y))));
  }
  EXPECT_LT(4 * worst, 48 * 0x1p-53);
}

// Eq. 2 as the page prints it; its first term needs a factor y.
TEST(SolidAngle, PrintedFormulaIsWrong) {
  const auto printed = [](double x, double y, bool corrected) {
    const double s = std::sqrt(1 - x * x - y * y);
    return (corrected ? y : 1) * std::atan(x / s) + x * std::atan(y / s) +
           (std::atan((1 - x - y * y) / (y * s)) - std::atan((1 + x - y * y) / (y * s))) / 2;
  };
  for (const auto& [x, y] : {std::pair{0.3, 0.4}, {0.7, 0.2}, {0.1, 0.9}}) {
    const double exact = static_cast<double>(by_quadrature(0, x, 0, y));
    EXPECT_GT(std::abs(printed(x, y, false) / exact - 1), 0.1);
    EXPECT_NEAR(printed(x, y, true), exact, 1e-14);
    EXPECT_NEAR(orthographic_solid_angle(0.0, x, 0.0, y), exact, 1e-15);
  }
}

TEST(SolidAngle, Edges) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_DOUBLE_EQ(orthographic_solid_angle(-infinity, infinity, -infinity, infinity), 2 * pi<double>);
  EXPECT_DOUBLE_EQ(orthographic_solid_angle(-9.0, 9.0, 0.0, 1.0), pi<double>);
  EXPECT_EQ(orthographic_solid_angle(1.0, 2.0, -1.0, 1.0), 0);
  EXPECT_EQ(orthographic_solid_angle(0.8, 0.9, 0.8, 0.9), 0);
  EXPECT_EQ(orthographic_solid_angle(0.1, 0.1, 0.0, 0.5), 0);
  EXPECT_EQ(orthographic_solid_angle(0.2, 0.1, 0.0, 0.5), 0);
  for (int k = 0; k < 4; ++k) {
    double a[] = {0.1, 0.2, 0.3, 0.4};
    a[k] = nan;
    EXPECT_TRUE(std::isnan(orthographic_solid_angle(a[0], a[1], a[2], a[3])));
  }
  // Symmetric, and additive across the axes.
  EXPECT_EQ(orthographic_solid_angle(0.1, 0.2, 0.5, 0.6), orthographic_solid_angle(-0.2, -0.1, 0.5, 0.6));
  EXPECT_EQ(orthographic_solid_angle(-1e-3, 2e-3, 0.5, 0.6),
            orthographic_solid_angle(0.0, 2e-3, 0.5, 0.6) + orthographic_solid_angle(0.0, 1e-3, 0.5, 0.6));
  // A cap at the rim, where 1/s is not bounded: between the circle and the chord x = 1 - h it is 2 pi h / 2.
  const double h = 1e-9, width = 1 - (1 - h);
  EXPECT_NEAR(orthographic_solid_angle(1 - h, 1.0, -1.0, 1.0) / (pi<double> * width), 1, 1e-13);
}

// k . integral of h: z is area, x and y by quadrature in polar coordinates about the pole.
TEST(SolidAngle, NormalIntegral) {
  Vec3<double> sum(0);
  constexpr int n = 64;
  double worst = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x0 = line(i, n, -1), x1 = line(i + 1, n, -1), y0 = line(j, n, -1), y1 = line(j + 1, n, -1);
      const Vec3<double> v = orthographic_normal_integral(x0, x1, y0, y1);
      sum += v;
      const double omega = orthographic_solid_angle(x0, x1, y0, y1);
      if (omega == 0) continue;
      // The mean direction lies over the pixel, and is shorter than 1 by the spread alone.
      EXPECT_GE(v.x, omega * std::max(x0, -1.0) - 1e-14);
      EXPECT_LE(v.x, omega * x1 + 1e-14);
      EXPECT_GE(v.y, omega * y0 - 1e-14);
      EXPECT_LE(v.y, omega * y1 + 1e-14);
      if (std::hypot(std::max(std::abs(x0), std::abs(x1)), std::max(std::abs(y0), std::abs(y1))) >= 1) continue;
      EXPECT_EQ(v.z, (x1 - x0) * (y1 - y0));
      double x = 0;  // Gauss quadrature of x / s
      boost::math::quadrature::gauss<double, 20> rule;
      x = rule.integrate(
          [&](double a) { return rule.integrate([&](double b) { return a / std::sqrt(1 - a * a - b * b); }, y0, y1); },
          x0, x1);
      if (std::hypot(x0, y0) < 0.8) worst = std::max(worst, std::abs(v.x - x));
    }
  EXPECT_LT(worst, 2e-15);
  EXPECT_NEAR(sum.x, 0, 1e-14);
  EXPECT_NEAR(sum.y, 0, 1e-14);
  EXPECT_NEAR(sum.z, pi<double>, 1e-13);
  // Half the hemisphere: the integral of x is that of cos^2 phi-like terms, pi / 2.
  EXPECT_NEAR(orthographic_normal_integral(0, 1, -1, 1).x, pi<double> / 2, 1e-15);
}

}  // namespace
}  // namespace gonio
