#include <cmath>

#include <gtest/gtest.h>

#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

glm::vec3 direction(double theta_degrees, double phi_degrees) {
  const double t = theta_degrees * pi<double> / 180, p = phi_degrees * pi<double> / 180;
  return glm::vec3(glm::dvec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)));
}

template <class Table>
void expect_gives_back(const Table& table, const LobeModel& model) {
  for (double theta_i : {5.0, 40.0, 70.0}) {
    for (double theta_o : {10.0, 45.0, 65.0}) {
      for (double phi : {10.0, 90.0, 170.0, 250.0}) {
        const glm::vec3 wi = direction(theta_i, 30), wo = direction(theta_o, 30 + phi);
        const glm::vec3 expected = model.eval(wi, wo), found = table.eval(wi, wo);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.01f * expected[c]);
      }
    }
  }
}

TEST(SynthesizeMerl, TheTableGivesBackTheModel) {
  const LobeModel model = parse_model("ggx+lambert:alpha=0.3,F0=0.1,albedo=0.5/0.3/0.1");
  const MerlTable table(synthesize_merl(model), {});
  expect_gives_back(table, model);
}

TEST(SynthesizeGrid, TheTableGivesBackTheModel) {
  const LobeModel model = parse_model("beckmann+lambert:alpha=0.4,F0=0.1,albedo=0.5/0.3/0.1");
  const MbsdfTable table(synthesize_mbsdf(model));
  expect_gives_back(table, model);
}

TEST(SynthesizeGrid, NoiseHasItsSigmaAndSeed) {
  const LobeModel model = parse_model("lambert:albedo=0.5");
  const float exact = static_cast<float>(0.5 / pi<double>);
  SynthOptions options;
  options.noise_sigma = 0.02;
  const MbsdfFile a = synthesize_mbsdf(model, 20, 40, options), b = synthesize_mbsdf(model, 20, 40, options);
  EXPECT_EQ(a.values, b.values);
  options.seed = 2;
  EXPECT_NE(a.values, synthesize_mbsdf(model, 20, 40, options).values);
  double sum = 0, square = 0;
  for (float value : a.values) {
    const double ratio = value / exact - 1;
    sum += ratio;
    square += ratio * ratio;
  }
  const double n = static_cast<double>(a.values.size());
  EXPECT_NEAR(sum / n, 0, 5 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square / n), 0.02, 0.0005);
}

TEST(Synthesize, HolesBeyondTheMeasuredAngle) {
  const LobeModel model = parse_model("lambert:albedo=0.5");
  SynthOptions options;
  options.measured_to = 60 * pi<double> / 180;
  const MbsdfFile grid = synthesize_mbsdf(model, 9, 4, options);
  for (int i = 0; i < 9; ++i) {
    for (int o = 0; o < 9; ++o) {
      const float value = grid.values[((i * 9 + o) * 4 + 2) * 3];
      EXPECT_EQ(std::isnan(value), i >= 6 || o >= 6) << i << " " << o;  // centres at 5, 15, ... degrees
    }
  }
  EXPECT_NO_THROW(MbsdfTable{grid});

  const MerlFile all = synthesize_merl(model), part = synthesize_merl(model, options);
  size_t missing_all = 0, missing_part = 0;
  for (size_t i = 0; i < all.values.size(); ++i) {
    missing_all += all.values[i] < 0;
    missing_part += part.values[i] < 0;
    if (part.values[i] >= 0) {
      ASSERT_EQ(part.values[i], all.values[i]);
    }
  }
  EXPECT_GT(missing_part, missing_all + all.values.size() / 10);
  EXPECT_NO_THROW(MerlTable(part, {}));
}

TEST(SynthesizeGrid, RefusesAGridOfNothing) {
  EXPECT_THROW(synthesize_mbsdf(parse_model("lambert"), 1, 10), Error);
  EXPECT_THROW(synthesize_mbsdf(parse_model("lambert"), 10, 0), Error);
}

}  // namespace
}  // namespace gonio
