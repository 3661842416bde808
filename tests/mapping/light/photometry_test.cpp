#include <numeric>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/photometry.h>

#include "tests/support/light_cases.h"

namespace gonio {
namespace {

using testing::rad;

TEST(Photometry, Lambertian) {
  const Luminaire light = testing::lambertian();
  const Photometry p = photometry(light.diagram);
  EXPECT_NEAR(p.flux, 1000, 0.1);
  EXPECT_DOUBLE_EQ(p.downward_flux, p.flux);
  EXPECT_NEAR(p.max_cd, 1000 / pi<double>, 1e-9);
  EXPECT_EQ(p.max_at.gamma, 0);
  EXPECT_NEAR(p.c0.beam, rad(120), 1e-9);  // cos 60 degrees = 1/2, a line of the table
  EXPECT_NEAR(p.c0.field, 2 * std::acos(0.1), 1e-5);
  EXPECT_NEAR(p.zones[2], 1000 * (std::pow(std::sin(rad(30)), 2) - std::pow(std::sin(rad(20)), 2)), 0.02);
  EXPECT_NEAR(std::accumulate(p.zones.begin(), p.zones.end(), 0.0), p.flux, 1e-9);
  EXPECT_NEAR(*light_output_ratio(light), 1, 1e-4);
  EXPECT_NEAR(*efficacy(light), 100, 0.01);
}

// Against a plain Riemann sum: closed form of the bilinear diagram, also over parts of cells.
TEST(Photometry, FluxIsTheIntegralOfTheBilinearDiagram) {
  const LightDiagram d = testing::asymmetric().diagram;
  const auto sum = [&](double from, double to) {
    double total = 0;
    const int n = 2000, m = 720;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < m; ++i) {
        const double g = from + (to - from) * (j + 0.5) / n;
        total += d.intensity(LightAngles{rad(0.5 * i + 0.25), g}) * std::sin(g) * (to - from) / n * rad(0.5);
      }
    return total;
  };
  EXPECT_NEAR(flux(d) / sum(0, pi<double>), 1, 1e-6);
  EXPECT_NEAR(flux(d, rad(33), rad(71)) / sum(rad(33), rad(71)), 1, 1e-6);
}

TEST(Photometry, MaximumAndSpreadOfAnAsymmetricBeam) {
  const LightDiagram d = testing::asymmetric().diagram;
  const Photometry p = photometry(d);
  EXPECT_NEAR(p.max_at.c, rad(30), 1e-12);
  EXPECT_NEAR(p.max_at.gamma, rad(40), 1e-12);
  LightFrame turned;  // C0 along the beam
  turned.c0 = LightFrame{}.direction(rad(30), rad(90));
  turned.c90 = LightFrame{}.direction(rad(120), rad(90));
  LightDiagram along = in_frame(d, turned);
  along.frame = LightFrame{};
  const double half = std::acos(1 + std::log(0.5) / 8);  // exp(8 (cos a - 1)) = 1/2
  EXPECT_NEAR(photometry(along).c0.beam, 2 * half, rad(0.5));
}

// Of a diagram with another axis, whose nodes lie between those of the frame.
TEST(Photometry, FluxAndMaximumDoNotDependOnTheFrame) {
  LightDiagram d = testing::tabulate(36, 45, pi<double>, [](double c, double g) {
    return std::abs(g - rad(40)) < 0.01 && std::abs(c - rad(30)) < 0.01 ? 1000.0 : 10.0;
  });
  d.frame.nadir = {1, 0, 0}, d.frame.c0 = {0, 0, 1}, d.frame.c90 = {0, 1, 0};
  const Photometry p = photometry(d);
  EXPECT_EQ(p.max_cd, 1000);
  EXPECT_LT(glm::length(LightFrame{}.direction(p.max_at.c, p.max_at.gamma) - d.frame.direction(rad(30), rad(40))),
            1e-12);
  EXPECT_DOUBLE_EQ(p.flux, flux(d));
}

TEST(Photometry, SpreadIsTheSmallestArc) {
  // Two wings with a dark nadir: the arc holds both, through the nadir.
  LightDiagram wings = testing::tabulate(
      1, 180, pi<double>, [](double, double g) { return std::max(0.0, 1 - std::abs(g - rad(45)) / rad(20)); });
  EXPECT_NEAR(photometry(wings).c0.beam, rad(110), 1e-9);  // 2 (45 + 10)
  // An even sphere: everything.
  LightDiagram even = testing::tabulate(1, 2, pi<double>, [](double, double) { return 5.0; });
  EXPECT_DOUBLE_EQ(photometry(even).c0.beam, 2 * pi<double>);
  // An even hemisphere ends at the horizon.
  LightDiagram half = testing::tabulate(1, 9, pi<double> / 2, [](double, double) { return 5.0; });
  EXPECT_NEAR(photometry(half).c0.field, pi<double>, 1e-6);
}

TEST(Photometry, Normalisation) {
  const LightDiagram d = testing::asymmetric().diagram;
  EXPECT_EQ(normalised(d, LightNormalisation::none).cd, d.cd);
  EXPECT_NEAR(flux(normalised(d, LightNormalisation::flux)), 1, 1e-12);
  EXPECT_NEAR(max_intensity(normalised(d, LightNormalisation::maximum, 3)), 3, 1e-12);
  LightDiagram dark = d;
  std::fill(dark.cd.begin(), dark.cd.end(), 0);
  EXPECT_THROW(normalised(dark, LightNormalisation::flux), Error);
}

TEST(LightDiagram, FramesAreExactAboutTheAxis) {
  const LightDiagram d = testing::asymmetric().diagram;
  for (double angle : {rad(90), rad(180), rad(40), rad(33.3)})
    for (int sense : {1, -1}) {
      LightFrame frame;
      frame.c0 = LightFrame{}.direction(angle, rad(90));
      frame.c90 = LightFrame{}.direction(angle + sense * rad(90), rad(90));
      const LightDiagram turned = in_frame(d, frame);
      EXPECT_NO_THROW(check(turned));
      EXPECT_LT(testing::largest_difference(d, turned), 1e-12) << angle << " " << sense;
    }
  LightFrame tilted;
  tilted.nadir = {1, 0, 0}, tilted.c0 = {0, 0, 1}, tilted.c90 = {0, 1, 0};
  const LightDiagram resampled = in_frame(d, tilted);
  EXPECT_NO_THROW(check(resampled));
  EXPECT_LT(testing::largest_difference(d, resampled), 0.02);
}

TEST(LightDiagram, AnglesNextToThePolesKeepTheirDigits) {
  const LightFrame frame;
  for (double g : {1e-9, 1e-5, pi<double> - 1e-9}) {
    const LightAngles a = to_light_angles(frame, frame.direction(1, g));
    EXPECT_NEAR(a.gamma / g, 1, 1e-7);
    EXPECT_NEAR(a.c, 1, 1e-6);
  }
}

TEST(LightDiagram, BrokenDiagramsAreRefused) {
  const auto broken = [](auto change) {
    LightDiagram d = testing::asymmetric().diagram;
    change(d);
    EXPECT_THROW(check(d), Error);
  };
  broken([](LightDiagram& d) { d.cd[5] = -1; });
  broken([](LightDiagram& d) { d.cd[5] = INFINITY; });
  broken([](LightDiagram& d) { d.cd[20] += 1; });  // the seam
  broken([](LightDiagram& d) { d.gamma.back() = 2; });
  broken([](LightDiagram& d) { d.c[3] = d.c[2]; });
  broken([](LightDiagram& d) { d.cd.pop_back(); });
}

}  // namespace
}  // namespace gonio
