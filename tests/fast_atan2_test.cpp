#include <gonio/mapping/fast_atan2.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gonio {
namespace {

TEST(FastAtan2, RelativeErrorInEveryOctantAndScale) {
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

TEST(FastAtan2, Axes) {
  const float half_pi = 1.57079633f;
  EXPECT_EQ(fast_atan2(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(fast_atan2(0.0f, 2.0f), 0.0f);
  EXPECT_FLOAT_EQ(fast_atan2(3.0f, 0.0f), half_pi);
  EXPECT_FLOAT_EQ(fast_atan2(-3.0f, 0.0f), -half_pi);
  EXPECT_FLOAT_EQ(fast_atan2(0.0f, -1.0f), 2 * half_pi);
}

}  // namespace
}  // namespace gonio
