#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/mapping/diagram/radial_cell.h>

namespace gonio {
namespace {

template <class T>
std::vector<RadialCell<T>> cells() {
  std::vector<RadialCell<T>> result;
  for (const T r0 : {T(0), T(1e-6), T(0.01), T(0.5), T(0.999)})
    for (const T h : {T(1e-6), T(1e-3), T(0.1), T(0.5)})
      for (const T d0 : {T(0), T(1e-9), T(1), T(1000)})
        for (const T d1 : {T(0), T(1e-9), T(1), T(1) + 8 * std::numeric_limits<T>::epsilon(), T(1.001), T(1000)})
          if (d0 + d1 > 0) result.push_back({r0, h, d0, d1});
  return result;
}

// The bound that radial_cell.h states.
template <class T>
void backward_stable() {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> random;
  for (const auto& cell : cells<T>()) {
    for (int k = 0; k < 500; ++k) {
      const double x = random(engine);
      const T tau = k == 0   ? T(1)
                    : k == 1 ? std::numeric_limits<T>::epsilon()
                             : static_cast<T>(k % 2 ? x : x * x * x * x);
      if (!(tau > 0)) continue;
      const T s = cell.invert(tau);
      ASSERT_GE(s, 0);
      ASSERT_LE(s, 1);
      // Judged in long double: how much mass really lies below the answer.
      const RadialCell<long double> exact{cell.r0, cell.h, cell.d0, cell.d1};
      const long double reached = exact.mass(s) / exact.mass(1);
      ASSERT_NEAR(static_cast<double>(reached - tau), 0, 16 * std::numeric_limits<T>::epsilon())
          << "r0 " << cell.r0 << " h " << cell.h << " d0 " << cell.d0 << " d1 " << cell.d1 << " tau " << tau;
    }
  }
}

TEST(RadialCell, InverseIsBackwardStable) {
  backward_stable<float>();
  backward_stable<double>();
}

TEST(RadialCell, RisesWithTau) {
  for (const auto& cell : cells<float>()) {
    float last = 0;
    for (int k = 1; k <= 1000; ++k) {
      const float s = cell.invert(static_cast<float>(k) / 1000);
      ASSERT_GE(s, last - 1e-3f);  // rounding may swap neighbours where the density vanishes
      last = s;
    }
  }
}

TEST(RadialCell, ClosedForms) {
  const RadialCell<double> constant{0.2, 0.5, 3, 3};  // eq. 12
  for (const double tau : {0.1, 0.5, 0.9}) {
    const double x = std::sqrt(0.04 + tau * (0.49 - 0.04));
    EXPECT_NEAR(constant.r0 + constant.h * constant.invert(tau), x, 1e-15);
  }
  const RadialCell<double> ramp{0, 1, 0, 1};  // mass s^3
  for (const double tau : {1e-12, 0.125, 0.5, 1.0}) EXPECT_NEAR(ramp.invert(tau), std::cbrt(tau), 1e-15);
}

// Eq. 9 as the mass of a whole cell, in the paper's own form.
TEST(RadialCell, MassIsEquation9) {
  const RadialCell<double> c{0.3, 0.25, 2, 5};
  const double x0 = 0.3, x1 = 0.55;
  const double paper =
      5 * (x1 * x1 - x0 * x0) + (2.0 - 5) / (x1 - x0) * (x1 * x1 * x1 / 3 - x1 * x0 * x0 + 2 * x0 * x0 * x0 / 3);
  EXPECT_NEAR(c.mass(1), paper, 1e-14);
}

// Negative control: Cardan's formula as printed (eq. 11) in float fails where d_j is nearly d_j+1.
TEST(RadialCell, TextbookCardanFails) {
  const auto textbook = [](const RadialCell<float>& c, float tau) {
    const float x0 = c.r0, x1 = c.r0 + c.h, q = (x1 - x0) / (c.d0 - c.d1);
    const float b = -1.5f * (c.d1 * q + x1);
    const float constant = 1.5f * ((tau * c.mass(1) + c.d1 * x0 * x0) * q + x1 * x0 * x0 - 2 * x0 * x0 * x0 / 3);
    const float p = -b * b / 3, r = 2 * b * b * b / 27 + constant, m = 2 * std::sqrt(-p / 3);
    float best = 1e9f;
    for (int k = 0; k < 3; ++k) {
      const float t =
          m *
          std::cos((std::acos(std::clamp(3 * r / (p * m), -1.0f, 1.0f)) - 2 * 3.14159265f * static_cast<float>(k)) / 3);
      const float x = t - b / 3;
      if (std::abs(x - (x0 + x1) / 2) < std::abs(best - (x0 + x1) / 2)) best = x;
    }
    return (best - x0) / (x1 - x0);
  };
  const RadialCell<float> cell{0.5f, 0.1f, 1.0f, 1.0f + 1e-5f};
  const float good = cell.invert(0.5f), bad = textbook(cell, 0.5f);
  EXPECT_NEAR(cell.mass(good) / cell.mass(1), 0.5, 1e-6);
  EXPECT_FALSE(std::abs(bad - good) < 1e-3);  // also true if it is NaN
}

}  // namespace
}  // namespace gonio
