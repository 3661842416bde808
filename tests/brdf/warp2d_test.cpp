#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <gonio/brdf/formats/rgl/warp2d.h>

namespace gonio {
namespace {

// Two slices of a rough density with zeros and a spike.
Warp2d make_warp(int height = 9, int width = 7) {
  std::mt19937 engine(4);
  std::uniform_real_distribution<float> uniform;
  std::vector<float> density;
  for (int i = 0; i < 2 * height * width; ++i) {
    const float value = uniform(engine);
    density.push_back(value < 0.2f ? 0.0f : value);
  }
  density[static_cast<std::size_t>(3 * width + 2)] = 500.0f;
  return Warp2d(2, height, width, density);
}

TEST(Warp2d, DensityIntegratesToOne) {
  const Warp2d warp = make_warp();
  for (const float t : {0.0f, 0.3f, 1.0f}) {
    const int n = 600;
    double sum = 0.0;
    for (int i = 0; i < n * n; ++i) {
      const auto at = [&](int k) { return (static_cast<float>(k) + 0.5f) / static_cast<float>(n); };
      sum += warp.eval({0, 1, t}, at(i % n), at(i / n));
    }
    EXPECT_NEAR(sum / (n * n), 1.0, 1e-3);
  }
}

TEST(Warp2d, InverseOfSample) {
  const Warp2d warp = make_warp();
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform;
  for (int i = 0; i < 10000; ++i) {
    const Lerp slice{0, 1, uniform(engine)};
    const float u = uniform(engine), v = uniform(engine);
    const Warp2d::Point point = warp.sample(slice, u, v);
    const Warp2d::Point back = warp.invert(slice, point.x, point.y);
    EXPECT_NEAR(back.x, u, 1e-4);
    EXPECT_NEAR(back.y, v, 1e-4);
    EXPECT_NEAR(back.density, point.density, 1e-3 * point.density + 1e-4);
    EXPECT_NEAR(warp.eval(slice, point.x, point.y), back.density, 1e-5 * back.density);
  }
}

// Means of x and y over a regular grid of (u, v) against those of the density.
TEST(Warp2d, SamplesFollowTheDensity) {
  const Warp2d warp = make_warp();
  const Lerp slice{0, 1, 0.4f};
  const int n = 500;
  double sampled[5] = {}, expected[5] = {};
  for (int i = 0; i < n * n; ++i) {
    const float a = (static_cast<float>(i % n) + 0.5f) / n, b = (static_cast<float>(i / n) + 0.5f) / n;
    const auto add = [](double* sums, double x, double y, double weight) {
      const double terms[5] = {x, y, x * x, y * y, x * y};
      for (int k = 0; k < 5; ++k) sums[k] += weight * terms[k];
    };
    const Warp2d::Point point = warp.sample(slice, a, b);
    add(sampled, point.x, point.y, 1.0);
    add(expected, a, b, warp.eval(slice, a, b));
  }
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(sampled[k] / expected[k], 1.0, 2e-3) << k;
}

TEST(Warp2d, EmptySliceBecomesUniformAndEdgesStayInside) {
  const Warp2d empty(1, 3, 4, std::vector<float>(12, 0.0f));
  const Warp2d::Point point = empty.sample({0, 0, 0.0f}, 0.3f, 0.6f);
  EXPECT_NEAR(point.x, 0.3f, 1e-6);
  EXPECT_NEAR(point.y, 0.6f, 1e-6);
  EXPECT_NEAR(point.density, 1.0f, 1e-6);
  const Warp2d warp = make_warp();
  for (const float u : {0.0f, 1.0f - 0x1p-24f, 1.0f}) {
    for (const float v : {0.0f, 1.0f - 0x1p-24f, 1.0f}) {
      const Warp2d::Point corner = warp.sample({0, 1, 0.5f}, u, v);
      EXPECT_TRUE(corner.x >= 0.0f && corner.x <= 1.0f && corner.y >= 0.0f && corner.y <= 1.0f);
      EXPECT_TRUE(std::isfinite(corner.density));
    }
  }
}

}  // namespace
}  // namespace gonio
