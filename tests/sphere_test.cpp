#include <gonio/mapping/error.h>
#include <gonio/mapping/light/emission.h>
#include <gonio/mapping/sphere.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cstdio>
#include <random>

#include "light_cases.h"

namespace gonio {
namespace {

using testing::rad;

SphereGrid grid_of(const std::vector<double>& phi, const std::vector<double>& theta, unsigned seed,
                   double zeros = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  SphereGrid grid{phi, theta, {}};
  for (std::size_t k = 0; k < phi.size() * theta.size(); ++k)
    grid.density.push_back(uniform(random) < zeros ? 0 : uniform(random));
  const std::size_t n = theta.size();
  for (std::size_t j = 0; j < n; ++j) grid.density[(phi.size() - 1) * n + j] = grid.density[j];
  for (std::size_t i = 0; i < phi.size(); ++i) {  // one value at each pole
    grid.density[i * n] = grid.density[0];
    if (theta.back() > 3) grid.density[i * n + n - 1] = grid.density[n - 1];
  }
  return grid;
}

SphereGrid random_grid(unsigned seed = 1, double zeros = 0) {
  return grid_of({0, 0.3, 1, 2, 2.1, 4, 5.5, 2 * pi<double>},
                 {0, 0.1, 0.5, 0.9, pi<double> / 2, 1.8, 2.6, 3.1, pi<double>}, seed, zeros);
}

/// The p-value of `draws` of a sampler against its pdf, in cells of equal solid angle; `pdf` is
/// integrated over each cell by midpoints. @param sample (u, v) -> direction.
template <class Sample, class Pdf>
double chi_square(const Sample& sample, const Pdf& pdf, int draws, unsigned seed) {
  constexpr int rows = 48, columns = 64, fine = 12;
  std::vector<double> expected(rows * columns), found(rows * columns);
  for (int y = 0; y < rows * fine; ++y)
    for (int x = 0; x < columns * fine; ++x) {
      const double z = 1 - 2 * (y + 0.5) / (rows * fine),
                   phi = 2 * pi<double> * (x + 0.5) / (columns * fine);
      const double s = std::sqrt(1 - z * z);
      expected[static_cast<std::size_t>(y / fine * columns + x / fine)] +=
          pdf(Vec3<double>{s * std::cos(phi), s * std::sin(phi), z}) * 4 * pi<double> /
          (rows * columns * fine * fine);
    }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < draws; ++k) {
    const Vec3<double> w = sample(uniform(random), uniform(random));
    double phi = std::atan2(w.y, w.x);
    if (phi < 0) phi += 2 * pi<double>;
    const int y = std::clamp(static_cast<int>((1 - w.z) / 2 * rows), 0, rows - 1);
    const int x = std::clamp(static_cast<int>(phi / (2 * pi<double>)*columns), 0, columns - 1);
    ++found[static_cast<std::size_t>(y * columns + x)];
  }
  // Cells that expect few draws are pooled.
  double statistic = 0, pooled_expected = 0, pooled_found = 0;
  int degrees = -1;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double e = expected[k] * draws;
    if (e < 20) {
      pooled_expected += e, pooled_found += found[k];
      continue;
    }
    statistic += (found[k] - e) * (found[k] - e) / e;
    ++degrees;
  }
  if (pooled_expected >= 5) {
    statistic +=
        (pooled_found - pooled_expected) * (pooled_found - pooled_expected) / pooled_expected;
    ++degrees;
  } else if (pooled_found > 5 * (pooled_expected + 2)) {
    return 0;
  }
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(degrees), statistic));
}

TEST(SphereDiagram, PdfIntegratesToOneAndDrawsFollowIt) {
  for (unsigned seed : {1u, 2u, 3u}) {
    const SphereDiagram<double> map(random_grid(seed, seed == 3 ? 0.3 : 0));
    const auto pdf = [&](const Vec3<double>& w) { return map.pdf(map.place_of(w)); };
    double sum = 0;
    const auto all = testing::directions(400000);
    for (const Vec3<double>& w : all) sum += pdf(w) * 4 * pi<double> / double(all.size());
    EXPECT_NEAR(sum, 1, 1e-4);
    EXPECT_GT(chi_square([&](double u, double v) { return map.direction(map.at(u, v)); }, pdf,
                         400000, seed),
              1e-3);
  }
}

// The test can fail: a pdf that is wrong by up to five percent is found out.
TEST(SphereDiagram, WrongPdfIsFoundOut) {
  const SphereDiagram<double> map(random_grid());
  const auto wrong = [&](const Vec3<double>& w) {
    return map.pdf(map.place_of(w)) * (1 + 0.05 * w.x);
  };
  EXPECT_LT(chi_square([&](double u, double v) { return map.direction(map.at(u, v)); }, wrong,
                       2000000, 1),
            1e-3);
}

template <class T>
void check_inverse(const SphereGrid& grid, double tolerance) {
  const SphereDiagram<T> map(grid);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const T u = static_cast<T>(uniform(random)), v = static_cast<T>(uniform(random));
    const auto place = map.at(u, v);
    const Vec3<T> w = map.direction(place);
    EXPECT_NEAR(double(w.x * w.x + w.y * w.y + w.z * w.z), 1,
                8 * double(std::numeric_limits<T>::epsilon()));
    const SquarePoint<T> back = map.square_of(map.place_of(w));
    worst = std::max({worst, double(std::abs(back.u - u)), double(std::abs(back.v - v))});
    EXPECT_NEAR(double(map.pdf(map.place_of(w))), double(map.pdf(place)), 20 * tolerance);
  }
  EXPECT_LT(worst, tolerance);
}

TEST(SphereDiagram, InverseUndoesTheMap) {
  check_inverse<double>(random_grid(), 1e-11);
  check_inverse<float>(random_grid(), 2e-4);
  check_inverse<double>(grid_of({0, 1, 2, 2 * pi<double>}, {0, 0.5, pi<double> / 2}, 5), 1e-11);
}

// Small steps in the square are small steps on the sphere, everywhere: along lines across the whole
// square, through the centre (a pole), the seam phi = 0 and the equator. Next to a pole a step
// grows like its square root; at a jump it would not shrink at all.
TEST(SphereDiagram, MapIsContinuous) {
  const SphereDiagram<double> map(random_grid());
  const auto longest_step = [&](int steps) {
    double longest = 0;
    for (int line = 0; line < 4; ++line) {
      Vec3<double> previous{0, 0, 0};
      for (int k = 0; k <= steps; ++k) {
        const double t = double(k) / steps;
        const double u = line == 1 ? 0.5 : line == 3 ? 0.71 : t;
        const double v = line == 2 ? 0.5 : t;
        const Vec3<double> w = map.direction(map.at(u, v));
        if (k > 0) longest = std::max(longest, glm::length(w - previous));
        previous = w;
      }
    }
    return longest;
  };
  EXPECT_LT(longest_step(400000), 0.012);
  EXPECT_LT(longest_step(400000) / longest_step(4000), 0.12);
}

// All of the square's edge is the far pole, and the edge of a hemispherical diagram the equator.
TEST(SphereDiagram, EdgeOfTheSquare) {
  const SphereDiagram<double> sphere(random_grid());
  const SphereDiagram<double> half(grid_of({0, 1, 2, 2 * pi<double>}, {0, 0.5, pi<double> / 2}, 5));
  EXPECT_FALSE(sphere.hemisphere());
  EXPECT_TRUE(half.hemisphere());
  for (double t : {0.0, 0.2, 0.5, 0.9, 1.0})
    for (const SquarePoint<double>& p : {SquarePoint<double>{t, 0}, {t, 1}, {0, t}, {1, t}}) {
      EXPECT_NEAR(sphere.direction(sphere.at(p.u, p.v)).z, -1, 1e-12);
      EXPECT_NEAR(half.direction(half.at(p.u, p.v)).z, 0, 1e-12);
    }
  EXPECT_EQ(sphere.direction(sphere.at(0.5, 0.5)).z, 1);
}

TEST(SphereDiagram, ExtremeNumbersStayFinite) {
  for (double zeros : {0.0, 0.5, 0.9}) {
    const SphereDiagram<float> map(random_grid(11, zeros));
    for (float u : {0.0f, 1e-30f, 0.25f, 0.5f, 1 - 0x1p-24f, 1.0f})
      for (float v : {0.0f, 1e-30f, 0.25f, 0.5f, 1 - 0x1p-24f, 1.0f}) {
        const auto place = map.at(u, v);
        const Vec3<float> w = map.direction(place);
        EXPECT_TRUE(std::isfinite(w.x) && std::isfinite(w.y) && std::isfinite(w.z));
        EXPECT_TRUE(map.pdf(place) >= 0 && std::isfinite(map.theta_linear(place)));
      }
  }
}

TEST(SphereDiagram, BadGridsAreRefused) {
  const auto broken = [](auto change) {
    SphereGrid grid = random_grid();
    change(grid);
    EXPECT_THROW(SphereDiagram<float>{grid}, Error);
  };
  broken([](SphereGrid& g) { g.density[3] = -1; });
  broken([](SphereGrid& g) { g.density[3] = NAN; });
  broken([](SphereGrid& g) { g.density.pop_back(); });
  broken([](SphereGrid& g) { g.density[2] += 1; });  // the seam
  broken([](SphereGrid& g) { g.theta[4] = 1.5; });   // no equator
  broken([](SphereGrid& g) { std::swap(g.phi[1], g.phi[2]); });
  broken([](SphereGrid& g) { std::fill(g.density.begin(), g.density.end(), 0); });
}

/// Everything that is asked of the sampling of one luminaire.
void check_emission(const LightDiagram& diagram, unsigned seed, bool fine_enough,
                    bool report = false) {
  const EmissionSampler<float> sampler(diagram);
  const auto sample = [&](double u, double v) {
    return Vec3<double>(sampler.sample(static_cast<float>(u), static_cast<float>(v)).direction);
  };
  const auto pdf = [&](const Vec3<double>& w) { return double(sampler.pdf(Vec3<float>(w))); };
  const double p = chi_square(sample, pdf, 200000, seed);
  EXPECT_GT(p, 1e-4);

  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  double mismatch = 0, inverse = 0;
  const double largest = max_intensity(diagram);
  const EmissionSampler<double> exact(diagram);
  for (int k = 0; k < 5000; ++k) {
    const double u = double(uniform(random)), v = double(uniform(random));
    const auto s = exact.sample(u, v);
    ASSERT_GT(s.pdf, 0);
    // weight * pdf is the intensity of the diagram in that direction.
    mismatch =
        std::max(mismatch, std::abs(s.weight * s.pdf - diagram.intensity(s.direction)) / largest);
    EXPECT_NEAR(exact.pdf(s.direction) / s.pdf, 1, 1e-6);
    const SquarePoint<double> back = exact.invert(s.direction);
    // Compared on the sphere: where hardly any mass lies, a tiny angle is a large step in the
    // square.
    inverse = std::max(inverse, glm::length(exact.sample(back.u, back.v).direction - s.direction));
  }
  EXPECT_LT(mismatch, 1e-7);
  EXPECT_LT(inverse, 1e-6);

  const auto quality = emission_quality(diagram);
  EXPECT_NEAR(quality[2].flux / sampler.mapped_flux(), 1, 1e-6);
  EXPECT_LT(quality[2].relvar, 1e-12);
  EXPECT_NEAR(quality[3].flux / flux(diagram), 1, 1e-3);
  if (fine_enough) {
    EXPECT_LT(quality[3].relvar, 1e-3);
  }
  if (report)
    std::printf(
        "  p %.3f  flux %+.4f %%  relvar: uniform %.3g, texels %.3g, r-linear %.1g, gamma-linear "
        "%.2g\n",
        p, 100 * (quality[3].flux / flux(diagram) - 1), quality[0].relvar, quality[1].relvar,
        quality[2].relvar, quality[3].relvar);
}

TEST(Emission, GeneratedLuminaires) {
  check_emission(testing::lambertian().diagram, 1, true);
  check_emission(testing::asymmetric().diagram, 2, true);
  check_emission(testing::narrow_spot().diagram, 3, true);
  check_emission(testing::uplight().diagram, 4, true);
}

TEST(Emission, OneHemisphereCostsHalf) {
  const EmissionSampler<float> down(testing::narrow_spot().diagram);
  EXPECT_TRUE(down.map().hemisphere());
  EXPECT_EQ(down.map().parallels(), 91);
  const EmissionSampler<float> up(testing::uplight().diagram);
  EXPECT_TRUE(up.map().hemisphere());
  EXPECT_EQ(up.pdf({0, 0, -1}), 0);
  EXPECT_GT(up.pdf({0, 0, 1}), 0);
  for (float u : {0.1f, 0.5f, 0.8f}) EXPECT_GT(up.sample(u, 0.7f).direction.z, 0);
  EXPECT_FALSE(EmissionSampler<float>(testing::asymmetric().diagram).map().hemisphere());
}

TEST(Emission, DarkLuminairesAreRefused) {
  LightDiagram dark = testing::lambertian().diagram;
  std::fill(dark.cd.begin(), dark.cd.end(), 0);
  EXPECT_THROW(EmissionSampler<float>{dark}, Error);
}

TEST(Emission, PhotometricFiles) {
  const auto files = testing::photometric_files();
  if (files.empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  unsigned seed = 100;
  for (const auto& path : files) {
    SCOPED_TRACE(path.string());
    const LightDiagram diagram = load_light(path).diagram;
    std::printf("%-34s", path.filename().string().c_str());
    check_emission(diagram, ++seed, diagram.gamma.size() >= 19, true);
  }
}

}  // namespace
}  // namespace gonio
