#include <gonio/tools/render/difference.h>

#include <gtest/gtest.h>

namespace gonio {
namespace {

TEST(Difference, RelativeErrorIsThatOfTheChosenPixels) {
  const RgbImage reference{4, 1, std::vector<glm::vec3>(4, glm::vec3(2))};
  RgbImage image = reference;
  EXPECT_EQ(relative_error(image, reference, {0, 1}).relmse, 0);
  image.pixels[1] = glm::vec3(3, 2, 2);
  image.pixels[3] = glm::vec3(100);
  // One channel of six is off by 1: 1 / (4 + 0.04) / 6; the spread over two pixels is that value.
  const RelativeError error = relative_error(image, reference, {0, 1});
  EXPECT_NEAR(error.relmse, 1 / 4.04 / 6, 1e-9);
  EXPECT_NEAR(error.standard_error, 1 / 4.04 / 6, 1e-9);
}

TEST(Difference, BlackAgreesWithBlack) {
  const RgbImage black{2, 1, std::vector<glm::vec3>(2, glm::vec3(0))};
  EXPECT_EQ(relative_error(black, black, {0, 1}).relmse, 0);
  EXPECT_EQ(difference_png(black, black).substr(1, 3), "PNG");
}

}  // namespace
}  // namespace gonio
