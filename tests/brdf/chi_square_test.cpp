#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <gonio/brdf/proof/statistics/chi_square.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio::proof {
namespace {

double cosine(const glm::vec3& w) { return w.z / pi<double>; }

glm::vec3 draw_cosine(Random& random) {
  const glm::vec2 u = random.pair();
  const float r = std::sqrt(u.x), phi = 2 * pi<float> * u.y;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x)};
}

const Bins& bins() {
  static const Bins b = Bins::adapted(cosine);
  return b;
}

constexpr std::uint64_t draws = 1000000;

TEST(ChiSquare, AcceptsTheRightPdf) {
  Random random(1);
  const auto result = chi_square([&](std::uint64_t) { return draw_cosine(random); }, cosine, bins(), draws);
  EXPECT_TRUE(result.passed(0.01)) << result.summary();
  EXPECT_NEAR(result.pdf_integral, 1, 1e-5);
  EXPECT_GT(result.degrees_of_freedom, 2000);
}

// p is uniform when nothing is wrong: the test neither always passes nor fails too often.
TEST(ChiSquare, PIsUniform) {
  Random random(2);
  double sum = 0;
  int low = 0;
  constexpr int repeats = 60;
  for (int k = 0; k < repeats; ++k) {
    const auto result = chi_square([&](std::uint64_t) { return draw_cosine(random); }, cosine, bins(), 60000);
    sum += result.p;
    low += result.p < 0.2;
  }
  EXPECT_NEAR(sum / repeats, 0.5, 3 * std::sqrt(1.0 / 12 / repeats));
  EXPECT_NEAR(low, 0.2 * repeats, 3 * std::sqrt(repeats * 0.16));
}

// The whole sphere: the bins meet at the equator, and each hemisphere has its own pole.
TEST(ChiSquare, Sphere) {
  const auto tilted = [](const glm::vec3& w) { return (1 + 0.5 * w.z) / (4 * pi<double>); };
  const Bins sphere = Bins::adapted(tilted, 31, 31, Domain::sphere);
  EXPECT_LT(sphere.index({0.6f, 0, -0.8f}), sphere.size());
  EXPECT_NE(sphere.index({0.6f, 0, -0.8f}), sphere.index({0.6f, 0, 0.8f}));
  Random random(3);
  const auto run = [&](double slope) {
    return chi_square(
        [&](std::uint64_t) {
          // The inverse of the cumulative of 1 + slope z.
          const glm::vec2 u = random.pair();
          const double z = (std::sqrt((1 - slope) * (1 - slope) + 4 * slope * u.x) - 1) / slope;
          const double s = std::sqrt(std::max(1 - z * z, 0.0)), phi = 2 * pi<double> * u.y;
          return glm::vec3(s * std::cos(phi), s * std::sin(phi), z);
        },
        tilted, sphere, draws);
  };
  const auto right = run(0.5), wrong = run(0.52);
  EXPECT_TRUE(right.passed(0.01)) << right.summary();
  EXPECT_NEAR(right.pdf_integral, 1, 1e-5);
  EXPECT_FALSE(wrong.passed(0.01)) << wrong.summary();
  EXPECT_THROW(Bins({-pi<double>, pi<double>}, {0, 1}, Domain::sphere), Error);
}

TEST(ChiSquare, NegativeControls) {
  Random random(1);
  const Draw draw = [&](std::uint64_t) { return draw_cosine(random); };
  // A pdf that tilts by a few per cent.
  const auto tilted = chi_square(
      draw, [](const glm::vec3& w) { return cosine(w) * (1 + 0.03 * w.x); }, bins(), draws);
  EXPECT_FALSE(tilted.passed(0.01)) << tilted.summary();
  // Half a texel aside: directions turned by 0.4 degrees towards +x.
  const auto shifted = chi_square(
      [&](std::uint64_t) {
        const glm::vec3 w = draw_cosine(random);
        const float a = 0.007f;
        const glm::vec3 s(w.x * std::cos(a) + w.z * std::sin(a), w.y, w.z * std::cos(a) - w.x * std::sin(a));
        return s.z > 0 ? s : w;
      },
      cosine, bins(), draws);
  EXPECT_FALSE(shifted.passed(0.01)) << shifted.summary();
  // A pdf that is 0 where draws fall.
  const auto hole = chi_square(
      draw, [](const glm::vec3& w) { return w.x > 0.9f ? 0 : cosine(w); }, bins(), draws);
  EXPECT_FALSE(hole.passed(0.01)) << hole.summary();
  EXPECT_GT(hole.where_zero, 0u);
  // Draws below the horizon.
  const auto below = chi_square([&](std::uint64_t k) { return k % 1000 ? draw_cosine(random) : glm::vec3(0, 0, -1); },
                                cosine, bins(), draws);
  EXPECT_FALSE(below.passed(0.01));
  EXPECT_EQ(below.outside, draws / 1000);
}

TEST(ChiSquare, ScaleIsSeenInTheIntegral) {  // the shape alone would pass
  Random random(1);
  const auto result = chi_square([&](std::uint64_t) { return draw_cosine(random); },
                                 [](const glm::vec3& w) { return 1.01 * cosine(w); }, bins(), 100000);
  EXPECT_NEAR(result.pdf_integral, 1.01, 1e-5);
}

TEST(ChiSquare, NarrowPeakIsCutIntoManyCells) {
  const auto peak = [](const glm::vec3& w) {
    const double dx = w.x + 0.5, dy = w.y;
    return std::exp(-(dx * dx + dy * dy) / (0.01 * 0.01)) / (pi<double> * 1e-4) + 0.1 * cosine(w);
  };
  const Bins b = Bins::adapted(peak);
  int inside = 0;
  for (std::size_t i = 0; i + 1 < b.phi().size(); ++i)
    for (std::size_t j = 0; j + 1 < b.r().size(); ++j) {
      const auto w =
          polar_to_direction(Polar<double>{(b.r()[j] + b.r()[j + 1]) / 2, (b.phi()[i] + b.phi()[i + 1]) / 2});
      inside += std::hypot(w.x + 0.5, w.y) < 0.01;
    }
  EXPECT_GT(inside, 25);
  double integral = 0;
  for (const double e : b.integrate(peak)) integral += e;
  EXPECT_NEAR(integral, 1 / std::sqrt(0.75) + 0.1, 2e-3);  // dA = cos dw on the disk; cos = sqrt(3)/2 at the peak
}

TEST(ChiSquare, Sidak) {
  EXPECT_NEAR(sidak(0.01, 1), 0.01, 1e-15);
  EXPECT_NEAR(std::pow(1 - sidak(0.01, 42), 42), 0.99, 1e-12);
}

TEST(ChiSquare, PlotStandsAlone) {
  Random random(1);
  const auto result = chi_square([&](std::uint64_t) { return draw_cosine(random); }, cosine, bins(), 10000);
  const auto path = std::filesystem::temp_directory_path() / "gonio_chi_square_test.svg";
  write_chi_square_plot(path.string(), bins(), result, "cosine");
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_NE(text.str().find("<svg"), std::string::npos);
  EXPECT_NE(text.str().find("</svg>"), std::string::npos);
  std::filesystem::remove(path);
}

TEST(Bins, RefusesBadEdges) {
  EXPECT_THROW(Bins({-pi<double>, pi<double>}, {0, 0.5, 0.4, 1}), Error);
  EXPECT_THROW(Bins({0, pi<double>}, {0, 1}), Error);
}

}  // namespace
}  // namespace gonio::proof
