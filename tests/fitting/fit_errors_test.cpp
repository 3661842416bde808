#include <cmath>

#include <gtest/gtest.h>

#include <gonio/fitting/fit/delta_e.h>
#include <gonio/fitting/fit/errors.h>

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
  // Nothing lies beyond 90 degrees.
  EXPECT_TRUE(std::isnan(r.beyond.relative_l1));
  EXPECT_TRUE(std::isnan(r.beyond.albedo));
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

// The largest difference between two angles of any grid, at the cut-off, and at the end.
TEST(FitErrors, AlbedoIsTheLargestOfAllAngles) {
  constexpr double degree = pi<double> / 180;
  const auto brighter = [](const auto& extra) -> BrdfFunction {
    return [=](const glm::vec3& wi, const glm::vec3&) {
      return glm::vec3(0.1f, 0.1f + static_cast<float>(extra(std::acos(static_cast<double>(wi.z)))), 0.1f);
    };
  };
  for (const double peak : {0.0, 11.3, 40.25, 74.1}) {
    const auto hill = [=](double theta) { return -0.05 * std::exp(-std::pow((theta - peak * degree) / degree, 2)); };
    EXPECT_NEAR(fit_errors(constant(0.1f), brighter(hill)).inside.albedo, 0.05 * pi<double>, 5e-4) << peak;
  }
  for (const double cutoff : {30.0, 75.0, 80.5}) {
    const auto slope = [](double theta) { return 0.1 * theta * theta; };
    const FitErrorReport r = fit_errors(constant(0.1f), brighter(slope), cutoff * degree);
    EXPECT_NEAR(r.inside.albedo / (slope(cutoff * degree) * pi<double>), 1, 2e-3);
    EXPECT_NEAR(r.beyond.albedo / (slope(last_albedo_angle) * pi<double>), 1, 2e-3);
  }
}

// The albedo of a lobe alone, by quadrature over outgoing directions.
TEST(FitErrors, AlbedoOfALobe) {
  constexpr double degree = pi<double> / 180;
  for (const double alpha : {0.05, 0.3, 1.0}) {
    const LobeModel model = parse_model("ggx:alpha=" + std::to_string(alpha) + ",F0=0.5,F90=0.1");
    const auto albedo = [&](double theta_i) {
      constexpr int n = 1000;
      double sum = 0;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const double theta = (i + 0.5) / n * pi<double> / 2, phi = (j + 0.5) / n * pi<double>;
          const glm::dvec3 wi(-std::sin(theta_i), 0, std::cos(theta_i));
          const glm::dvec3 wo(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
          sum += model.eval(wi, wo).r * wo.z * std::sin(theta);
        }
      return sum * pi<double> * pi<double> / (n * n);
    };
    const double expected = std::max({albedo(0), albedo(25 * degree), albedo(50 * degree), albedo(75 * degree)});
    const BrdfFunction f = [&](const glm::vec3& wi, const glm::vec3& wo) { return model.eval(wi, wo); };
    EXPECT_NEAR(fit_errors(constant(0), f).inside.albedo / expected, 1, 0.005) << alpha;
  }
}

// What is NaN was not measured, and has no part in any error.
TEST(FitErrors, OfWhatWasMeasured) {
  constexpr double degree = pi<double> / 180;
  const float lowest = std::cos(30 * pi<float> / 180);
  const auto cut = [=](float value) -> BrdfFunction {
    return [=](const glm::vec3& wi, const glm::vec3& wo) {
      return glm::vec3(wi.z < lowest || wo.z < lowest ? std::numeric_limits<float>::quiet_NaN() : value);
    };
  };
  const FitErrorReport part = fit_errors(cut(0.1f), constant(0.11f)),
                       whole = fit_errors(constant(0.1f), constant(0.11f), 30 * degree);
  EXPECT_EQ(part.inside.cosine_rms, whole.inside.cosine_rms);
  EXPECT_EQ(part.inside.log_rms, whole.inside.log_rms);
  EXPECT_EQ(part.inside.relative_l1, whole.inside.relative_l1);
  EXPECT_EQ(part.inside.delta_e, whole.inside.delta_e);
  EXPECT_NEAR(part.inside.albedo, 0.01 * pi<double> / 4, 2e-4);  // sin^2 of 30 degrees of the hemisphere's
  for (const double e :
       {part.beyond.cosine_rms, part.beyond.log_rms, part.beyond.relative_l1, part.beyond.albedo, part.beyond.delta_e})
    EXPECT_TRUE(std::isnan(e));
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
