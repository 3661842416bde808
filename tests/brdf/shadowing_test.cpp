#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <gonio/brdf/ndf/image/shadowing.h>

#include "tests/support/ndf_cases.h"

namespace gonio {
namespace {

using namespace test;

constexpr double degree = pi<double> / 180;

/// Largest error of the image of G1 up to 85 degrees, against the closed form.
template <class Ndf>
double worst_error(const Ndf& analytic, int size) {
  DiskImage d = rasterise(size, analytic);
  const double before = normalise(d);
  EXPECT_NEAR(before, 1, 2e-3);
  const Shadowing shadowing(d);
  const DiskImage g1 = g1_image(shadowing, size);
  double worst = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      Vec3<double> k;
      if (!pixel_direction(size, row, column, k)) {
        EXPECT_EQ(g1.at(row, column), 0);
        continue;
      }
      const double error = std::abs(static_cast<double>(g1.at(row, column)) - analytic.g1(k));
      if (k.z > std::cos(85 * degree)) worst = std::max(worst, error);
    }
  return worst;
}

TEST(Shadowing, ClosedFormsAt512) {
  for (const auto& [ax, ay] :
       {std::pair{0.02, 0.02}, {0.05, 0.05}, {0.1, 0.1}, {0.3, 0.3}, {0.6, 0.6}, {1.0, 1.0}, {0.1, 0.4}, {0.5, 0.05}}) {
    const double ggx = worst_error(GgxNdf{ax, ay}, 512), beckmann = worst_error(BeckmannNdf{ax, ay}, 512);
    EXPECT_LT(ggx, 3e-4) << "GGX " << ax << ' ' << ay;
    EXPECT_LT(beckmann, 3e-4) << "Beckmann " << ax << ' ' << ay;
  }
}

TEST(Shadowing, FastIsTheDirectSum) {
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> uniform;
  // Two tilted lobes of different width, away from all symmetry; and noise.
  DiskImage lobes = rasterise(200, [](const Vec3<double>& h) {
    return std::exp(-300 * (std::pow(h.x - 0.5, 2) + std::pow(h.y + 0.3, 2))) +
           std::exp(-20 * (h.x * h.x + std::pow(h.y - 0.8, 2)));
  });
  DiskImage noise(64);
  for (float& v : noise.values) v = static_cast<float>(std::pow(uniform(engine), 8));
  for (DiskImage* d : {&lobes, &noise}) {
    normalise(*d);
    const Shadowing shadowing(*d);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3<double> k = at(90 * degree * uniform(engine), 2 * pi<double> * uniform(engine));
      worst = std::max(worst, std::abs(shadowing.sigma(k) - shadowing.sigma_direct(k)));
    }
    EXPECT_LT(worst, 1e-4);
  }
}

// From the normal everything is seen once: sigma is the area of the surface itself.
TEST(Shadowing, NormalIncidence) {
  DiskImage d = rasterise(64, GgxNdf{0.7, 0.2});
  normalise(d);
  const Shadowing shadowing(d);
  EXPECT_NEAR(shadowing.sigma({0, 0, 1}), 1, 1e-6);
  EXPECT_NEAR(shadowing.g1({0, 0, 1}), 1, 1e-6);
  EXPECT_EQ(shadowing.g1({1, 0, 0}), 0);
}

// Seen from both sides of one azimuth, a tilted facet shows its front to one of them.
TEST(Shadowing, OneFacet) {
  constexpr int n = 256;
  DiskImage d(n);
  const int row = 60, column = 200;
  d.at(row, column) = 1;
  normalise(d);
  Vec3<double> h;
  ASSERT_TRUE(pixel_direction(n, row, column, h));
  EXPECT_GT(h.x, 0);
  EXPECT_GT(h.y, 0);  // above the middle of the image
  const Shadowing shadowing(d);
  const double phi = std::atan2(h.y, h.x), theta = std::acos(h.z);
  for (const double t : {0.0, 0.3, 0.9, 1.3}) {
    EXPECT_NEAR(shadowing.sigma(at(t, phi)), std::cos(t - theta) / h.z, 2e-3);
    EXPECT_NEAR(shadowing.sigma(at(t, phi + pi<double>)), std::max(std::cos(t + theta), 0.0) / h.z, 2e-3);
  }
}

}  // namespace
}  // namespace gonio
