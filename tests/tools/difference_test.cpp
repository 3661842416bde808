#include "tools/render/image/difference.h"

#include <gtest/gtest.h>

#include "tests/support/png_pixels.h"

namespace gonio {
namespace {

using Pixels = std::vector<std::array<int, 3>>;

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
  EXPECT_EQ(test::png_pixels(difference_png(black, black)), (Pixels(2, {255, 255, 255})));
}

// A quarter too bright is half of the full colour.
TEST(Difference, TooBrightIsRedAndTooDarkIsBlue) {
  const RgbImage reference{4, 1, std::vector<glm::vec3>(4, glm::vec3(2))};
  const RgbImage image{4, 1, {glm::vec3(2.5f), glm::vec3(9), glm::vec3(1.5f), glm::vec3(0)}};
  EXPECT_EQ(test::png_pixels(difference_png(image, reference)),
            (Pixels{{217, 128, 128}, {179, 0, 0}, {128, 128, 217}, {0, 0, 179}}));
}

}  // namespace
}  // namespace gonio
