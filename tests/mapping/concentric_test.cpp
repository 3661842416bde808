#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <gonio/mapping/charts/concentric.h>

namespace gonio {
namespace {

TEST(Concentric, NamedPoints) {
  const auto at = [](double u, double v) { return square_to_disk(u, v); };
  EXPECT_EQ(at(0.5, 0.5).r2, 0);
  EXPECT_DOUBLE_EQ(at(1, 0.5).turn, 0);
  EXPECT_DOUBLE_EQ(at(1, 1).turn, 0.125);  // the corner is on the diagonal, at the rim
  EXPECT_DOUBLE_EQ(at(1, 1).r2, 1);
  EXPECT_DOUBLE_EQ(at(0.5, 1).turn, 0.25);
  EXPECT_DOUBLE_EQ(at(0, 0.5).turn, 0.5);
  EXPECT_DOUBLE_EQ(at(0.5, 0).turn, 0.75);
  EXPECT_DOUBLE_EQ(at(1, 0).turn, 0.875);
}

// Havran et al. ask for phi in [0, 2 pi), which the original map does not give.
TEST(Concentric, TurnStaysInHalfOpenRange) {
  const float below = std::nextafter(0.5f, 0.0f);
  for (const float u : {0.0f, 0.3f, 0.7f, 1.0f, 1 - 0x1p-24f})
    for (const float v : {0.0f, below, 0.5f, std::nextafter(0.5f, 1.0f), 1.0f}) {
      const auto p = square_to_disk(u, v);
      EXPECT_GE(p.turn, 0) << u << ' ' << v;
      EXPECT_LT(p.turn, 1) << u << ' ' << v;
      EXPECT_LE(p.r2, 1);
    }
}

template <class T>
void round_trip(T bound) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> random;
  for (int k = 0; k < 100000; ++k) {
    const T u = static_cast<T>(random(engine)), v = static_cast<T>(random(engine));
    const auto back = disk_to_square(square_to_disk(u, v));
    ASSERT_LE(std::abs(back.u - u), bound);
    ASSERT_LE(std::abs(back.v - v), bound);
  }
}

TEST(Concentric, RoundTrip) {
  round_trip<float>(4e-7f);
  round_trip<double>(1e-15);
  round_trip<long double>(1e-15L);
}

// Equal areas: a uniform square fills rings and sectors of equal size alike.
TEST(Concentric, PreservesArea) {
  constexpr int side = 500, rings = 5, sectors = 7;
  int count[rings][sectors] = {};
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const auto p = square_to_disk((i + 0.5) / side, (j + 0.5) / side);
      ++count[static_cast<int>(p.r2 * rings)][static_cast<int>(p.turn * sectors)];
    }
  const double expected = side * side / static_cast<double>(rings * sectors);
  for (const auto& ring : count)
    for (const int n : ring) EXPECT_NEAR(n, expected, 0.02 * expected);
}

}  // namespace
}  // namespace gonio
