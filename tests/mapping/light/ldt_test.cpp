#include <cstdio>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/texture/light_texture.h>
#include <gonio/mapping/light/texture/solid.h>

#include "tests/support/light_cases.h"

namespace gonio {
namespace {

using testing::rad;

constexpr LightFilter filters[] = {LightFilter::bilinear, LightFilter::catmull_rom, LightFilter::mitchell,
                                   LightFilter::bspline};
constexpr LightFilter interpolating[] = {LightFilter::bilinear, LightFilter::catmull_rom, LightFilter::bspline};

TEST(LightFilter, WeightsSumToOneAndAreMirrored) {
  for (LightFilter filter : filters)
    for (float t = 0; t <= 1; t += 0.0625f) {
      const auto w = filter_weights(filter, t), m = filter_weights(filter, 1 - t);
      EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-6);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(w[k], m[3 - k], 1e-6);
      // The first moment: linear functions are reproduced.
      EXPECT_NEAR(-w[0] + w[2] + 2 * w[3], t, 1e-6);
    }
  EXPECT_NEAR(filter_weights(LightFilter::mitchell, 0)[1], 16.0 / 18, 1e-6);
  EXPECT_NEAR(filter_weights(LightFilter::mitchell, 0)[0], 1.0 / 18, 1e-6);
}

TEST(LightTexture, SizesFollowTheSymmetry) {
  const LightTexture rotational(testing::lambertian().diagram, LightFilter::bilinear);
  EXPECT_EQ(rotational.m_c(), 1);
  EXPECT_EQ(rotational.n_gamma(), 91);  // the dark hemisphere has no texels
  const LightTexture spot(testing::narrow_spot().diagram, LightFilter::bilinear);
  EXPECT_EQ(spot.n_gamma(), 91);
  const LightTexture full(testing::asymmetric().diagram, LightFilter::bilinear);
  EXPECT_EQ(full.m_c(), 36);
  EXPECT_EQ(full.n_gamma(), 37);
  EXPECT_EQ(full.texels().size(), 36u * 39u);
  const LightTexture up(testing::uplight().diagram, LightFilter::bilinear);
  EXPECT_NEAR(up.gamma_from(), rad(90), 1e-6);
}

// Every filter but Mitchell's goes through the values of the file; half a texel off would show.
TEST(LightTexture, InterpolatingFiltersHitTheNodes) {
  for (const Luminaire& light :
       {testing::lambertian(), testing::asymmetric(), testing::uplight(), testing::narrow_spot()})
    for (LightFilter filter : interpolating) {
      const LightTexture texture(light.diagram, filter);
      const LightDiagram& d = light.diagram;
      double worst = 0;
      for (std::size_t i = 0; i + 1 < d.c.size(); ++i)
        for (std::size_t j = 0; j < d.gamma.size(); ++j)
          worst = std::max(worst, std::abs(texture.intensity(d.frame.direction(d.c[i], d.gamma[j])) - d.at(i, j)));
      EXPECT_LT(worst / max_intensity(d), 2e-5) << light.name << " filter " << static_cast<int>(filter);
    }
}

TEST(LightTexture, BilinearIsTheDiagram) {
  for (const Luminaire& light : {testing::lambertian(), testing::asymmetric(), testing::uplight()}) {
    const LightTexture texture(light.diagram, LightFilter::bilinear);
    double worst = 0;
    for (const Vec3<double>& w : testing::directions(50000))
      worst = std::max(worst, std::abs(texture.intensity(w) - light.diagram.intensity(w)));
    EXPECT_LT(worst / max_intensity(light.diagram), 1e-5) << light.name;
  }
}

// One value at a pole, whatever the meridian, and none of the filters jumps there or at the seam.
TEST(LightTexture, PolesAndSeamAreContinuous) {
  const LightDiagram d = testing::asymmetric().diagram;
  for (LightFilter filter : filters) {
    const LightTexture texture(d, filter);
    for (double pole : {0.0, pi<double>}) {
      double lowest = 1e9, highest = -1e9;
      for (int k = 0; k < 360; ++k) {
        const double v = texture.intensity(LightFrame{}.direction(rad(k), std::abs(pole - 1e-5)));
        lowest = std::min(lowest, v), highest = std::max(highest, v);
      }
      EXPECT_LT((highest - lowest) / max_intensity(d), 2e-4);
    }
    for (int k = 1; k < 180; ++k) {
      const double g = rad(k);
      EXPECT_NEAR(texture.intensity(LightFrame{}.direction(-1e-6, g)),
                  texture.intensity(LightFrame{}.direction(1e-6, g)), 0.01);
    }
  }
}

TEST(LightTexture, CubicFiltersAreSmoothAcrossThePole) {
  // The slope along a great circle through the nadir, before and behind it.
  const LightDiagram d = testing::asymmetric().diagram;
  for (LightFilter filter : {LightFilter::catmull_rom, LightFilter::bspline}) {
    const LightTexture texture(d, filter);
    const auto at = [&](double angle) {
      return texture.intensity(LightFrame{}.direction(angle < 0 ? rad(210) : rad(30), std::abs(angle)));
    };
    const double h = rad(0.2), before = (at(0) - at(-h)) / h, behind = (at(h) - at(0)) / h;
    EXPECT_NEAR(before / behind, 1, 0.03) << static_cast<int>(filter);
  }
}

TEST(LightTexture, SmoothFiltersAreCloserToASmoothLuminaire) {
  const LightDiagram d = testing::asymmetric().diagram;
  const Vec3<double> down = testing::asymmetric_peak(), up = LightFrame{}.direction(rad(200), rad(130));
  double rms[4] = {};
  for (LightFilter filter : filters) {
    const LightTexture texture(d, filter);
    for (const Vec3<double>& w : testing::directions(20000)) {
      const double truth = 1000 * std::exp(8 * (glm::dot(w, down) - 1)) + 250 * std::exp(12 * (glm::dot(w, up) - 1));
      rms[static_cast<int>(filter)] += std::pow(texture.intensity(w) - truth, 2);
    }
  }
  EXPECT_LT(rms[1], 0.2 * rms[0]);
  EXPECT_LT(rms[3], 0.5 * rms[1]);
}

TEST(LightTexture, LambertianFluxThroughEveryFilter) {
  const LightDiagram d = testing::lambertian().diagram;
  for (LightFilter filter : filters) {
    const LightTexture texture(d, filter);
    EXPECT_NEAR(texture.intensity({0, 0, -1}), 1000 / pi<double>, 0.02) << static_cast<int>(filter);
    double sum = 0;
    const int n = 20000;
    for (int j = 0; j < n; ++j) {
      const double g = rad(90) * (j + 0.5) / n;
      sum += texture.intensity(LightFrame{}.direction(1, g)) * 2 * pi<double> * std::sin(g) * rad(90) / n;
    }
    EXPECT_NEAR(sum, 1000, 0.1) << static_cast<int>(filter);
    EXPECT_EQ(texture.intensity({0, 0, 1}), 0);
  }
}

TEST(LightTexture, UnevenAnglesAreTabulatedAnew) {
  LightDiagram d = testing::asymmetric().diagram;
  LightDiagram uneven = with_parallel(with_parallel(d, rad(42.5)), rad(1));
  const LightTexture texture(uneven, LightFilter::bilinear);
  EXPECT_EQ(texture.n_gamma(), 361);  // 0.5 degrees has all lines
  double worst = 0;
  for (const Vec3<double>& w : testing::directions(20000))
    worst = std::max(worst, std::abs(texture.intensity(w) - d.intensity(w)));
  EXPECT_LT(worst / max_intensity(d), 1e-4);
  std::fill(d.cd.begin(), d.cd.end(), 0);
  EXPECT_THROW((LightTexture{d, LightFilter::bilinear}), Error);
}

TEST(LightTexture, PointLightFollowsTheInverseSquare) {
  const LightTexture texture(testing::lambertian().diagram, LightFilter::bilinear);
  const float lux = point_light(texture, static_cast<float>(texture.max_cd()), {0, 0, -2});
  EXPECT_NEAR(lux, 1000 / pi<double> / 4, 1e-3);
  EXPECT_NEAR(point_light(texture, 100, {3, 0, -4}), 100 * 0.8 / 25, 1e-3);  // dimmed to 100 cd
  EXPECT_EQ(point_light(texture, 100, {0, 0, 1}), 0);
}

TEST(TwoPlanes, ExactOnThePlanes) {
  const LightDiagram d = testing::asymmetric().diagram;
  for (double c : {0.0, 90.0, 180.0, 270.0})
    for (double g = 5; g < 180; g += 7) {
      const Vec3<double> w = LightFrame{}.direction(rad(c), rad(g));
      EXPECT_NEAR(two_plane_intensity(d, w), d.intensity(w), 1e-6);
    }
  EXPECT_NEAR(two_plane_intensity(d, {0, 0, -1}), d.intensity({0, 0, -1}), 1e-9);
}

TEST(TwoPlanes, EllipticSectionsAreReproduced) {
  // At the horizon the projections are the axes themselves: an ellipse with semi-axes 3 and 1.
  const LightDiagram d = testing::tabulate(4, 18, pi<double>, [](double c, double g) {
    return g == pi<double> || g == 0 ? 2.0 : std::abs(std::cos(c)) > 0.5 ? 3.0 : 1.0;
  });
  const double c = rad(30);
  EXPECT_NEAR(two_plane_intensity(d, LightFrame{}.direction(c, rad(90))),
              std::sqrt(9 * std::pow(std::cos(c), 2) + std::pow(std::sin(c), 2)), 1e-9);
}

TEST(Compare, EqualIsZeroAndScaledIsFound) {
  const LightDiagram d = testing::asymmetric().diagram;
  const LightDifference same = compare(bilinear_reconstruction(d), bilinear_reconstruction(d), 60);
  EXPECT_EQ(same.hausdorff, 0);
  EXPECT_EQ(same.rms, 0);
  LightDiagram larger = testing::tabulate(1, 2, pi<double>, [](double, double) { return 11.0; });
  LightDiagram sphere = testing::tabulate(1, 2, pi<double>, [](double, double) { return 10.0; });
  const LightDifference off = compare(bilinear_reconstruction(sphere), bilinear_reconstruction(larger), 60);
  EXPECT_NEAR(off.hausdorff, 0.1, 2e-3);  // two spheres of radius 1 and 1.1
  EXPECT_NEAR(off.rms, 0.1, 1e-9);
  EXPECT_NEAR(off.flux, 0.1, 1e-9);
}

// A narrow spike turned by a little: large differences of intensity, a small distance of the
// solids.
TEST(Compare, HausdorffIsADistanceOfSolids) {
  const auto spike = [](double tilt) {
    const Vec3<double> axis = LightFrame{}.direction(0, rad(tilt));
    return Reconstruction([axis](const Vec3<double>& w) { return std::exp(200 * (glm::dot(w, axis) - 1)); });
  };
  const LightDifference turned = compare(spike(40), spike(44), 180);
  EXPECT_NEAR(turned.hausdorff, 2 * std::sin(rad(2)), 0.02);
  EXPECT_GT(turned.largest, 0.25);
}

TEST(Compare, EverySecondAngleIsLeftOut) {
  const LightDiagram d = testing::asymmetric().diagram, half = every_second(d);
  EXPECT_EQ(half.gamma.size(), 19u);
  EXPECT_EQ(half.c.size(), 19u);
  EXPECT_NO_THROW(check(half));
  const Prediction linear = predict_left_out(d, bilinear_reconstruction(half));
  const Prediction cubic = predict_left_out(d, texture_reconstruction(LightTexture(half, LightFilter::catmull_rom)));
  EXPECT_EQ(linear.angles, 36u * 37u - 18u * 19u - 2u * 18u);
  EXPECT_LT(cubic.rms, 0.5 * linear.rms);
  EXPECT_EQ(predict_left_out(d, bilinear_reconstruction(d)).largest < 1e-9, true);
}

TEST(Compare, PhotometricFiles) {
  const auto files = testing::photometric_files();
  if (files.empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  constexpr const char* names[] = {"bilinear", "catmull-rom", "mitchell", "b-spline"};
  double sums[4] = {};
  int count = 0;
  for (const auto& path : files) {
    const LightDiagram d = load_light(path).diagram;
    if (d.gamma.size() < 19 || d.gamma.size() % 2 == 0) continue;
    const LightDiagram half = every_second(d);
    std::printf("%-34s", path.filename().string().c_str());
    for (LightFilter filter : filters) {
      const auto rebuilt = texture_reconstruction(LightTexture(half, filter));
      const Prediction p = predict_left_out(d, rebuilt);
      std::printf("  %s rms %.4f", names[static_cast<int>(filter)], p.rms);
      EXPECT_LT(p.rms, 0.2) << path;
      sums[static_cast<int>(filter)] += p.rms;
    }
    std::printf("\n");
    ++count;
  }
  for (int k = 0; k < 4; ++k)
    std::printf("mean of %d files, %s: rms %.5f of I_max\n", count, names[k], sums[k] / count);
  EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace gonio
