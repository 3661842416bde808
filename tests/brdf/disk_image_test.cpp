#include <limits>

#include <gtest/gtest.h>

#include <gonio/brdf/ndf/image/disk_image.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/ndf_cases.h"

namespace gonio {
namespace {

using namespace test;

TEST(DiskImage, PixelsAndDirections) {
  const PixelBounds p = pixel_bounds(4, 0, 3);  // top right
  EXPECT_EQ(p.x0, 0.5);
  EXPECT_EQ(p.x1, 1);
  EXPECT_EQ(p.y0, 0.5);
  EXPECT_EQ(p.y1, 1);
  Vec3<double> w(7);
  EXPECT_FALSE(pixel_direction(4, 0, 3, w));
  EXPECT_EQ(w.x, 7);
  ASSERT_TRUE(pixel_direction(4, 2, 1, w));
  EXPECT_EQ(w.x, -0.25);
  EXPECT_EQ(w.y, -0.25);
  EXPECT_DOUBLE_EQ(w.z, std::sqrt(1 - 0.125));
}

// A distribution with integral 1 has it as an image too: narrower than a pixel, or up to the horizon.
TEST(DiskImage, RasterisedDistributionsAreNormalised) {
  for (const double a : {0.005, 0.05, 0.5, 1.0}) {
    EXPECT_NEAR(projected_area(rasterise(256, GgxNdf{a, a})), 1, 1e-3) << a;
    EXPECT_NEAR(projected_area(rasterise(256, BeckmannNdf{a, a})), 1, 1e-3) << a;
    EXPECT_NEAR(projected_area(rasterise(255, GgxNdf{a, 0.3})), 1, 1e-3) << a;
  }
}

// D = 1: half the sphere's area per unit disk; the sums are exact in every resolution.
TEST(DiskImage, AreasOfConstants) {
  for (const int n : {1, 2, 3, 64, 333}) {
    DiskImage d = rasterise(n, [](const Vec3<double>&) { return 1.0; });
    EXPECT_NEAR(projected_area(d), pi<double>, 1e-12) << n;
    EXPECT_NEAR(microsurface_area(d), 2 * pi<double>, 1e-12) << n;
    EXPECT_NEAR(normalise(d), pi<double>, 1e-12);
    EXPECT_NEAR(projected_area(d), 1, 1e-6);
  }
}

TEST(DiskImage, MedianSlopes) {
  const MedianSlopes ggx = median_slopes(rasterise(512, GgxNdf{0.1, 0.4}));
  EXPECT_NEAR(ggx.x * std::sqrt(3), 0.1, 0.005);
  EXPECT_NEAR(ggx.y * std::sqrt(3), 0.4, 0.005);
  const MedianSlopes beckmann = median_slopes(rasterise(512, BeckmannNdf{0.5, 0.2}));
  EXPECT_NEAR(beckmann.x / 0.4769, 0.5, 0.006);
  EXPECT_NEAR(beckmann.y / 0.4769, 0.2, 0.006);
}

TEST(DiskImage, RefusesWhatIsNoDistribution) {
  DiskImage d(16);
  EXPECT_THROW(normalise(d), Error);
  d.at(0, 0) = std::numeric_limits<float>::quiet_NaN();  // outside the disk: not read
  d.at(8, 8) = 1;
  EXPECT_NEAR(normalise(d), 4.0 / 256, 1e-12);
  EXPECT_EQ(d.at(0, 0), 0);
  for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    d.at(5, 6) = bad;
    try {
      normalise(d);
      ADD_FAILURE() << bad;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("row 5, column 6"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(rasterise(0, GgxNdf{1, 1}), Error);
  EXPECT_THROW(rasterise(max_disk_image_side + 1, GgxNdf{1, 1}), Error);
}

}  // namespace
}  // namespace gonio
