#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <gonio/mapping/numeric/fast_math.h>

namespace gonio {
namespace {

TEST(FastMath, Atan2InEveryOctantAndScale) {
  std::mt19937 engine(8);
  std::uniform_real_distribution<double> exponent(-12.0, 0.0);
  double largest = 0.0;
  for (int i = 0; i < 1000000; ++i) {
    const auto draw = [&] {
      const double sign = engine() % 2 ? 1.0 : -1.0;
      return static_cast<float>(sign * std::pow(10.0, exponent(engine)));
    };
    const float y = draw(), x = draw();
    const double exact = std::atan2(static_cast<double>(y), static_cast<double>(x));
    largest = std::max(largest, std::abs(static_cast<double>(fast_atan2(y, x)) / exact - 1.0));
  }
  EXPECT_LT(largest, 2e-7);
}

TEST(FastMath, Atan2OnTheAxes) {
  const float half_pi = 1.57079633f;
  EXPECT_EQ(fast_atan2(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(fast_atan2(0.0f, 2.0f), 0.0f);
  EXPECT_FLOAT_EQ(fast_atan2(3.0f, 0.0f), half_pi);
  EXPECT_FLOAT_EQ(fast_atan2(-3.0f, 0.0f), -half_pi);
  EXPECT_FLOAT_EQ(fast_atan2(0.0f, -1.0f), 2 * half_pi);
}

TEST(FastMath, SinCos) {
  for (int k = -200000; k <= 200000; ++k) {
    const float x = 8 * static_cast<float>(k) / 200000;
    const SinCos<float> fast = sin_cos(x);
    ASSERT_NEAR(fast.sin, std::sin(static_cast<double>(x)), 1.2e-7) << x;
    ASSERT_NEAR(fast.cos, std::cos(static_cast<double>(x)), 1.2e-7) << x;
    ASSERT_NEAR(fast.sin * fast.sin + fast.cos * fast.cos, 1, 2.5e-7) << x;
  }
}

TEST(FastMath, CubeRootInEveryOctave) {
  for (int octave = -120; octave < 127; ++octave)
    for (int k = 0; k < 1000; ++k) {
      const float x = std::ldexp(1 + static_cast<float>(k) / 1000, octave);
      const double exact = std::cbrt(static_cast<double>(x));
      const CubeRoot<float> fast = cube_root(x);
      ASSERT_NEAR(fast.root / exact, 1, 3e-7) << x;
      ASSERT_NEAR(fast.inverse * exact, 1, 3e-7) << x;
    }
  EXPECT_LT(cube_root(0.0f).root, 1e-12f);
}

TEST(FastMath, CosThird) {
  for (int k = -100000; k <= 100000; ++k) {
    const float x = static_cast<float>(k) / 100000;
    ASSERT_NEAR(cos_third(x) / std::cos(std::acos(static_cast<double>(x)) / 3), 1, 3e-7) << x;
  }
}

TEST(FastMath, SelectTakesEitherBitByBit) {
  EXPECT_EQ(select(true, 1.5f, -0.0f), 1.5f);
  EXPECT_TRUE(std::signbit(select(false, 1.5f, -0.0f)));
  EXPECT_TRUE(std::isnan(select(true, std::nanf(""), 1.0f)));
  EXPECT_EQ(select(false, std::nanf(""), 1.0f), 1.0f);
}

}  // namespace
}  // namespace gonio
