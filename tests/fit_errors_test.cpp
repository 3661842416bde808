#include <gonio/fitting/delta_e.h>
#include <gonio/fitting/errors.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gonio {
namespace {

BrdfFunction constant(float value) {
  return [value](const glm::vec3&, const glm::vec3&) { return glm::vec3(value); };
}

TEST(FitErrors, VanishForTheSame) {
  const FitErrorReport r = fit_errors(constant(0.1f), constant(0.1f));
  for (const FitErrors& e : {r.inside, r.beyond}) {
    EXPECT_EQ(e.cosine_rms, 0);
    EXPECT_EQ(e.log_rms, 0);
    EXPECT_EQ(e.relative_l1, 0);
    EXPECT_EQ(e.albedo, 0);
    EXPECT_EQ(e.delta_e, 0);
  }
}

TEST(FitErrors, KnownForAScaledLambert) {
  const float f = 0.1f;
  const FitErrorReport r = fit_errors(constant(f), constant(1.1f * f), pi<double> / 2);
  EXPECT_NEAR(r.inside.relative_l1, 0.1, 1e-5);
  EXPECT_NEAR(r.inside.albedo, 0.01 * pi<double>, 2e-4);
  // The mean of cos^2 over the hemisphere is 1/3.
  EXPECT_NEAR(r.inside.cosine_rms, 0.01 / std::sqrt(3.0), 1e-4);
  EXPECT_NEAR(r.inside.log_rms, std::log(1.1), 0.01);  // the offset takes a little off
  EXPECT_GT(r.inside.delta_e, 0.5);
  EXPECT_LT(r.inside.delta_e, 5);
  EXPECT_EQ(r.beyond.relative_l1, 0);
}

TEST(FitErrors, AreKeptApartByTheCutoff) {
  const float lowest = std::cos(60 * pi<float> / 180);
  const BrdfFunction grazing = [&](const glm::vec3& wi, const glm::vec3& wo) {
    return glm::vec3(wi.z < lowest || wo.z < lowest ? 0.3f : 0.1f);
  };
  const FitErrorReport r = fit_errors(constant(0.1f), grazing, 60 * pi<double> / 180);
  EXPECT_EQ(r.inside.cosine_rms, 0);
  EXPECT_EQ(r.inside.relative_l1, 0);
  EXPECT_EQ(r.inside.delta_e, 0);
  EXPECT_NEAR(r.beyond.relative_l1, 2, 1e-4);
  EXPECT_GT(r.beyond.delta_e, 5);
}

// Sharma, Wu and Dalal 2005, table 1.
TEST(DeltaE, PublishedPairs) {
  const auto d = [](glm::dvec3 a, glm::dvec3 b) { return delta_e_2000(a, b); };
  EXPECT_NEAR(d({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
  EXPECT_NEAR(d({50, -1.3802, -84.2814}, {50, 0, -82.7485}), 1.0000, 1e-4);
  EXPECT_NEAR(d({50, 0, 0}, {50, -1, 2}), 2.3669, 1e-4);
  EXPECT_NEAR(d({50, 2.49, -0.001}, {50, -2.49, 0.0009}), 7.1792, 1e-4);
  EXPECT_NEAR(d({50, 2.5, 0}, {50, 0, -2.5}), 4.3065, 1e-4);
  EXPECT_NEAR(d({50, 2.5, 0}, {73, 25, -18}), 27.1492, 1e-4);
  EXPECT_NEAR(d({50, 2.5, 0}, {50, 3.1736, 0.5854}), 1.0000, 1e-4);
  EXPECT_NEAR(d({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}), 1.2644, 1e-4);
  EXPECT_NEAR(d({2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}), 0.9082, 1e-4);
}

TEST(DeltaE, LabOfWhiteAndGrey) {
  const glm::dvec3 white = lab_from_rgb({1, 1, 1});
  EXPECT_NEAR(white.x, 100, 1e-3);
  EXPECT_NEAR(white.y, 0, 1e-2);
  EXPECT_NEAR(white.z, 0, 1e-2);
  EXPECT_NEAR(lab_from_rgb(glm::dvec3(0.18)).x, 49.5, 0.05);
}

}  // namespace
}  // namespace gonio
