#include <algorithm>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include <gonio/brdf/proof/coherence.h>
#include <gonio/brdf/proof/statistics/chi_square.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/emission.h>
#include <gonio/mapping/sphere/sphere.h>

#include "tests/support/light_cases.h"

namespace gonio {
namespace {

using testing::rad;

SphereGrid grid_of(const std::vector<double>& phi, const std::vector<double>& theta, unsigned seed, double zeros = 0) {
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

/// Draws of a sampler against its pdf, in bins of the sphere that are adapted to it.
/// @param sample (u, v) -> direction.
template <class Sample>
proof::ChiSquare chi_square(const Sample& sample, const proof::Density& pdf, std::uint64_t draws, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const proof::Draw draw = [&](std::uint64_t) {
    const double u = uniform(random), v = uniform(random);
    return glm::vec3(sample(u, v));
  };
  return proof::chi_square(draw, pdf, proof::Bins::adapted(pdf, 61, 61, proof::Domain::sphere), draws);
}

/// Bends, tears and folds of the map of a luminaire; there is no incident direction.
proof::Coherence coherence(const EmissionSampler<double>& sampler) {
  proof::Subject subject;
  subject.sample = [&](const glm::vec3&, const glm::vec2& u) {
    const auto s = sampler.sample(double(u.x), double(u.y));
    return BsdfSample{glm::vec3(s.direction), static_cast<float>(s.pdf), glm::vec3(1)};
  };
  return proof::measure_coherence(subject, 0);
}

TEST(SphereDiagram, PdfIntegratesToOneAndDrawsFollowIt) {
  for (unsigned seed : {1u, 2u, 3u}) {
    const SphereDiagram<double> map(random_grid(seed, seed == 3 ? 0.3 : 0));
    const auto pdf = [&](const glm::vec3& w) { return map.pdf(map.position_of(Vec3<double>(w))); };
    const auto result = chi_square([&](double u, double v) { return map.direction(map.at(u, v)); }, pdf, 1000000, seed);
    EXPECT_NEAR(result.pdf_integral, 1, 1e-4);
    EXPECT_TRUE(result.passed(proof::sidak(0.01, 3))) << result.summary();
  }
}

// The test can fail: a pdf that is wrong by up to five percent is found out.
TEST(SphereDiagram, WrongPdfIsFoundOut) {
  const SphereDiagram<double> map(random_grid());
  const auto wrong = [&](const glm::vec3& w) {
    return map.pdf(map.position_of(Vec3<double>(w))) * (1 + 0.05 * double(w.x));
  };
  const auto result = chi_square([&](double u, double v) { return map.direction(map.at(u, v)); }, wrong, 1000000, 1);
  EXPECT_FALSE(result.passed(1e-6)) << result.summary();
}

template <class T>
void check_inverse(const SphereGrid& grid, double tolerance) {
  const SphereDiagram<T> map(grid);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const T u = static_cast<T>(uniform(random)), v = static_cast<T>(uniform(random));
    const auto position = map.at(u, v);
    const Vec3<T> w = map.direction(position);
    EXPECT_NEAR(double(w.x * w.x + w.y * w.y + w.z * w.z), 1, 8 * double(std::numeric_limits<T>::epsilon()));
    const SquarePoint<T> back = map.square_of(map.position_of(w));
    worst = std::max({worst, double(std::abs(back.u - u)), double(std::abs(back.v - v))});
    EXPECT_NEAR(double(map.pdf(map.position_of(w))), double(map.pdf(position)), 20 * tolerance);
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
        const auto position = map.at(u, v);
        const Vec3<float> w = map.direction(position);
        EXPECT_TRUE(std::isfinite(w.x) && std::isfinite(w.y) && std::isfinite(w.z));
        EXPECT_TRUE(map.pdf(position) >= 0 && std::isfinite(map.theta_linear(position)));
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

/// With a hundredth of the largest intensity added everywhere.
LightDiagram with_floor(LightDiagram diagram) {
  const double floor = max_intensity(diagram) / 100;
  for (double& cd : diagram.cd) cd += floor;
  return diagram;
}

/// A sector of C that was measured and ends abruptly (type B): where the intensities themselves
/// have a step, the map bends over an angle that no float of the square tells from a jump.
bool ends_abruptly(const LightDiagram& d) {
  for (std::size_t i = 1; i < d.c.size(); ++i)
    if (d.c[i] - d.c[i - 1] < 1.5 * edge_width) return true;
  return false;
}

/// Everything that is asked of the sampling of one luminaire; @param tests how many chi-square
/// tests share the significance.
void check_emission(const LightDiagram& diagram, unsigned seed, bool fine_enough, int tests, bool report = false) {
  const EmissionSampler<float> sampler(diagram);
  const auto sample = [&](double u, double v) {
    return sampler.sample(static_cast<float>(u), static_cast<float>(v)).direction;
  };
  const auto pdf = [&](const glm::vec3& w) { return double(sampler.pdf(w)); };
  const auto chi2 = chi_square(sample, pdf, 200000, seed);
  EXPECT_TRUE(chi2.passed(proof::sidak(0.01, tests))) << chi2.summary();
  EXPECT_NEAR(chi2.pdf_integral, 1, 1e-3);

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
    mismatch = std::max(mismatch, std::abs(s.weight * s.pdf - diagram.intensity(s.direction)) / largest);
    EXPECT_NEAR(exact.pdf(s.direction) / s.pdf, 1, 1e-6);
    const SquarePoint<double> back = exact.invert(s.direction);
    // Compared on the sphere: where hardly any mass lies, a tiny angle is a large step in the
    // square.
    inverse = std::max(inverse, glm::length(exact.sample(back.u, back.v).direction - s.direction));
  }
  EXPECT_LT(mismatch, 1e-7);
  EXPECT_LT(inverse, 1e-6);
  // The map has no choice but to jump over what is dark: it is continuous where no such gap lies in
  // between, and on the same luminaire with light everywhere.
  const auto as_it_is = coherence(exact), lit = coherence(EmissionSampler<double>(with_floor(diagram)));
  EXPECT_EQ(as_it_is.folds, 0u);
  EXPECT_EQ(lit.folds, 0u);
  if (!ends_abruptly(diagram)) {
    EXPECT_EQ(lit.tears, 0u);
  }
  if (*std::min_element(diagram.cd.begin(), diagram.cd.end()) > 0.01 * largest) {
    EXPECT_EQ(as_it_is.tears, 0u);
  }

  const auto quality = emission_quality(diagram);
  EXPECT_NEAR(quality[2].flux / sampler.mapped_flux(), 1, 1e-6);
  EXPECT_LT(quality[2].relvar, 1e-12);
  EXPECT_NEAR(quality[3].flux / flux(diagram), 1, 1e-3);
  if (fine_enough) {
    EXPECT_LT(quality[3].relvar, 1e-3);
  }
  if (report)
    std::printf(
        "  p %.3f  jumps %2d  flux %+.4f %%  relvar: uniform %.3g, texels %.3g, r-linear %.1g, "
        "gamma-linear %.2g\n",
        chi2.p, static_cast<int>(as_it_is.tears), 100 * (quality[3].flux / flux(diagram) - 1), quality[0].relvar,
        quality[1].relvar, quality[2].relvar, quality[3].relvar);
}

TEST(Emission, GeneratedLuminaires) {
  check_emission(testing::lambertian().diagram, 1, true, 4, true);
  check_emission(testing::asymmetric().diagram, 2, true, 4, true);
  check_emission(testing::narrow_spot().diagram, 3, true, 4, true);
  check_emission(testing::uplight().diagram, 4, true, 4, true);
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
    check_emission(diagram, ++seed, diagram.gamma.size() >= 19, static_cast<int>(files.size()), true);
  }
}

}  // namespace
}  // namespace gonio
