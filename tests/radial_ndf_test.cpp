#include <gonio/brdf/ndf/radial_ndf.h>
#include <gonio/brdf/ndf/shadowing.h>
#include <gonio/mapping/error.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "ndf_cases.h"

namespace gonio {
namespace {

using namespace test;

constexpr double degree = pi<double> / 180;

template <class Ndf>
RadialNdf radial(const Ndf& ndf) {
  return RadialNdf(512, [&](double theta) { return ndf(at(theta, 0)); });
}

template <class Ndf>
void expect_closed_form(const Ndf& analytic) {
  RadialNdf d = radial(analytic);
  EXPECT_NEAR(d.normalise(), 1, 2e-3);
  EXPECT_NEAR(d.projected_area(), 1, 1e-12);
  for (double t = 0; t <= 85; t += 2.5) EXPECT_NEAR(d.g1(t * degree), analytic.g1(at(t * degree, 0)), 1e-3) << t;
}

TEST(RadialNdf, G1OfGgxAndBeckmann) {
  for (const double a : {0.005, 0.02, 0.1, 0.5, 1.0}) {
    SCOPED_TRACE(a);
    expect_closed_form(GgxNdf{a, a});
    expect_closed_form(BeckmannNdf{a, a});
    EXPECT_NEAR(std::tan(radial(GgxNdf{a, a}).median_theta()) / a, 1, 0.02);
    EXPECT_NEAR(std::tan(radial(BeckmannNdf{a, a}).median_theta()) / (a * std::sqrt(std::log(2))), 1, 0.02);
  }
}

TEST(RadialNdf, AgreesWithTheImage) {
  RadialNdf d = radial(GgxNdf{0.3, 0.3});
  d.normalise();
  DiskImage image = rasterise(256, [&](const Vec3<double>& h) { return d.eval(std::acos(h.z)); });
  EXPECT_NEAR(normalise(image), 1, 1e-3);
  const Shadowing shadowing(image);
  for (double t = 0; t <= 85; t += 5) EXPECT_NEAR(shadowing.g1(at(t * degree, 0.7)), d.g1(t * degree), 1e-3) << t;
}

/// f_r(k, k) of a microfacet material with F(0) = 0.05.
template <class Ndf>
auto retro_reflection(const Ndf& ndf) {
  return [=](double theta) {
    const Vec3<double> k = at(theta, 0);
    return 0.05 * ndf(k) * ndf.g1(k) / (4 * k.z * k.z);
  };
}

template <class Ndf>
void expect_extracted(const Ndf& analytic) {
  const ExtractedNdf found = extract_ndf(retro_reflection(analytic));
  EXPECT_LT(found.change, 1e-9);
  EXPECT_LT(found.iterations, 1000);
  EXPECT_NEAR(found.ndf.projected_area(), 1, 1e-12);
  const double peak = analytic(at(0, 0));
  for (double t = 0; t <= 85; t += 2.5) {
    const double expected = analytic(at(t * degree, 0));
    EXPECT_NEAR(found.ndf.eval(t * degree), expected, 0.005 * expected + 1e-4 * peak) << t;
    EXPECT_NEAR(found.ndf.g1(t * degree), analytic.g1(at(t * degree, 0)), 2e-3) << t;
  }
}

TEST(RadialNdf, ExtractionFindsTheDistribution) {
  for (const double a : {0.02, 0.1, 0.4, 0.8}) {
    SCOPED_TRACE(a);
    expect_extracted(GgxNdf{a, a});
    expect_extracted(BeckmannNdf{a, a});
  }
}

// What the eigenvector problem is for: f_r cos^2, the first guess, is far off where shadowing matters.
TEST(RadialNdf, ExtractionBeatsDivisionByCosines) {
  const GgxNdf ggx{0.8, 0.8};
  const auto f_r = retro_reflection(ggx);
  RadialNdf naive(512, [&](double theta) { return f_r(std::min(theta, 89 * degree)) * std::pow(std::cos(std::min(theta, 89 * degree)), 2); });
  naive.normalise();
  const double t = 60 * degree, expected = ggx(at(t, 0));
  EXPECT_GT(std::abs(naive.eval(t) / expected - 1), 0.1);
  EXPECT_LT(std::abs(extract_ndf(f_r).ndf.eval(t) / expected - 1), 0.01);
}

TEST(RadialNdf, RefusesWhatIsNoDistribution) {
  EXPECT_THROW(RadialNdf(1, [](double) { return 1.0; }), Error);
  EXPECT_THROW(RadialNdf(9, [](double) { return -1.0; }), Error);
  EXPECT_THROW(RadialNdf(9, [](double) { return std::nan(""); }), Error);
  EXPECT_THROW(RadialNdf(9, [](double) { return 0.0; }).normalise(), Error);
  EXPECT_THROW(extract_ndf([](double) { return 0.0; }), Error);
}

}  // namespace
}  // namespace gonio
