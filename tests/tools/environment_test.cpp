#include "tools/render/image/environment.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

#include "tools/render/trace/sobol.h"

namespace gonio {
namespace {

RgbImage spots() {
  RgbImage image{16, 8, std::vector<glm::vec3>(128, glm::vec3(0))};
  image.pixels[8 + 16 * 3] = glm::vec3(10, 20, 5);  // right of the middle
  image.pixels[0 + 16 * 7] = glm::vec3(3);          // below, at the seam
  return image;
}

// E[radiance / pdf] is the integral of the radiance, which uniform directions estimate as well.
TEST(Environment, SamplesIntegrateToThePower) {
  const Environment environment(spots(), "test", 0.3f);
  double by_pdf = 0, uniform = 0, total_pdf = 0;
  constexpr int n = 1 << 16;
  for (std::uint32_t k = 0; k < n; ++k) {
    PathSequence random(1, 1, k);
    const auto s = environment.sample(random.next());
    ASSERT_TRUE(s);
    EXPECT_NEAR(glm::length(s->direction), 1, 1e-5f);
    by_pdf += static_cast<double>(luminance(environment.radiance(s->direction)) / s->pdf) / n;
    const glm::vec2 u = random.next();
    const float z = 1 - 2 * u.x, r = std::sqrt(1 - z * z), phi = 2 * pi<float> * u.y;
    const glm::vec3 w(r * std::cos(phi), r * std::sin(phi), z);
    uniform += 4 * pi<double> * static_cast<double>(luminance(environment.radiance(w))) / n;
    total_pdf += 4 * pi<double> * static_cast<double>(environment.pdf(w)) / n;
    EXPECT_TRUE(environment.pdf(w) > 0 || luminance(environment.radiance(w)) == 0);
  }
  EXPECT_NEAR(total_pdf, 1, 2e-3);
  EXPECT_NEAR(by_pdf / uniform, 1, 2e-3);
}

TEST(Environment, TheMiddleLooksAlongXAndTurnsCounterClockwise) {
  RgbImage image{4, 2, std::vector<glm::vec3>(8, glm::vec3(0))};
  for (int row = 0; row < 2; ++row) {
    image.pixels[static_cast<std::size_t>(4 * row + 1)] = {1, 0, 0};  // left of the middle: towards +y
    image.pixels[static_cast<std::size_t>(4 * row + 2)] = {0, 1, 0};
  }
  const Environment straight(image, "test"), turned(image, "test", pi<float> / 2);
  const float a = pi<float> / 4;
  EXPECT_EQ(straight.radiance({std::cos(a), std::sin(a), 0}).r, 1.0f);
  EXPECT_EQ(straight.radiance({std::cos(a), -std::sin(a), 0}).g, 1.0f);
  EXPECT_NEAR(turned.radiance({-std::sin(a), std::cos(a), 0}).r, 1.0f, 1e-5f);
}

TEST(Environment, BlackIsNotDrawnFrom) {
  const Environment black({2, 1, std::vector<glm::vec3>(2, glm::vec3(0))}, "test");
  EXPECT_FALSE(black.sample({0.3f, 0.7f}));
  EXPECT_EQ(black.pdf({0, 0, 1}), 0.0f);
}

TEST(Environment, RefusesWhatIsNoRadiance) {
  EXPECT_THROW(Environment({1, 1, {glm::vec3(-1)}}, "test"), Error);
  EXPECT_THROW(Environment({1, 1, {glm::vec3(std::nanf(""))}}, "test"), Error);
  EXPECT_THROW(Environment({1, 1, {glm::vec3(2e12f)}}, "test"), Error);
  EXPECT_THROW(Environment({0, 0, {}}, "test"), Error);
}

}  // namespace
}  // namespace gonio
