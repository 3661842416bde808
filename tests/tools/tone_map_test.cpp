#include "tools/render/image/tone_map.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/png_pixels.h"

namespace gonio {
namespace {

using Pixels = std::vector<std::array<int, 3>>;

// By hand: luminance 0.58825 makes a factor of 0.65277, of red 1, green 0.5 and blue 0.25.
TEST(ToneMap, KnownPixels) {
  const RgbImage image{
      3, 2, {{1, 0.5f, 0.25f}, {4, 4, 4}, {0, 0, 0}, {2, 0, 0}, {0.001f, 0.002f, 0.0005f}, {2, 1, 0.5f}}};
  const Pixels pixels = test::png_pixels(tone_mapped_png(image));
  EXPECT_EQ(pixels, (Pixels{{211, 155, 112}, {255, 255, 255}, {0, 0, 0}, {255, 0, 0}, {3, 7, 2}, {253, 186, 136}}));
  EXPECT_EQ(test::png_pixels(tone_mapped_png(image, 0.5f)).back(), pixels.front());
}

TEST(ToneMap, WhatIsNotFiniteIsBlack) {
  constexpr float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
  const RgbImage image{4, 1, {glm::vec3(infinite), {infinite, 0, 0}, glm::vec3(none), {1, none, 1}}};
  EXPECT_EQ(test::png_pixels(tone_mapped_png(image)), Pixels(4, {0, 0, 0}));
}

}  // namespace
}  // namespace gonio
