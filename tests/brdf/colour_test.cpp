#include <vector>

#include <gtest/gtest.h>

#include <gonio/brdf/value/colour.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

TEST(Colour, KeepsItsValues) {
  const std::vector<glm::vec3> values{{1, 0, 100}, {0.001f, 3, 1e-9f}};
  const Colour colour({0.2f}, 2, values);
  const std::vector<glm::vec3> held = colour.values();
  for (std::size_t k = 0; k < 2; ++k)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(held[k][c], values[k][c], values[k][c] / 2048 + 100 * 0x1p-40f);
  EXPECT_EQ(Colour({0.2f}, 2, held).values(), held);
}

TEST(Colour, LinearBetweenItsAngles) {
  const Colour colour({0.2f, 1.0f}, 2, {{1, 1, 1}, {1, 1, 1}, {3, 3, 3}, {3, 3, 3}});
  EXPECT_NEAR(colour.eval(0.6f, {0.4f, 0.7f}).x, 2, 1e-3);
  EXPECT_NEAR(colour.eval(0.0f, {0.4f, 0.7f}).x, 1, 1e-3);
  EXPECT_NEAR(colour.eval(1.5f, {0.4f, 0.2f}).x, 3, 1e-3);
}

TEST(Colour, RefusesBadInput) {
  const std::vector<glm::vec3> two(2, glm::vec3(1));
  EXPECT_THROW(Colour({}, 2, {}), Error);
  EXPECT_THROW(Colour({0.1f}, 3, two), Error);
  EXPECT_THROW(Colour({0.1f, 0.1f}, 2, {4, glm::vec3(1)}), Error);
  EXPECT_THROW(Colour({2.0f}, 2, two), Error);
  EXPECT_THROW(Colour({0.1f}, 2, {{1, 1, 1}, {-1, 1, 1}}), Error);
  EXPECT_THROW(Colour({0.1f}, 2, {{1, 1, 1}}), Error);
  EXPECT_THROW(Colour({0.1f}, 2, {{1, 1.001e6f, 1}, {1, 1, 1}}), Error);
  EXPECT_NO_THROW(Colour({0.1f}, 2, {{1, 1e6f, 1}, {1, 1, 1}}));
}

}  // namespace
}  // namespace gonio
