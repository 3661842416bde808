#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <ceres/gradient_checker.h>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <gonio/brdf/formats/merl.h>
#include <gonio/fitting/fit/fit.h>
#include <gonio/fitting/fit/linear_start.h>
#include <gonio/fitting/fit/residual.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

BrdfFunction exact(const LobeModel& model) {
  return [model](const glm::vec3& wi, const glm::vec3& wo) { return model.eval(wi, wo); };
}

// 2 % multiplicative noise that belongs to the pair of directions, as in a table.
BrdfFunction noisy(const LobeModel& model) {
  return [model](const glm::vec3& wi, const glm::vec3& wo) {
    glm::vec3 value = model.eval(wi, wo);
    std::uint32_t words[6];
    for (int i = 0; i < 3; ++i) {
      words[i] = static_cast<std::uint32_t>(std::lround(wi[i] * 1e8f));
      words[i + 3] = static_cast<std::uint32_t>(std::lround(wo[i] * 1e8f));
    }
    std::seed_seq seed(words, words + 6);
    std::minstd_rand random(seed);
    std::normal_distribution<float> normal(1, 0.02f);
    for (int c = 0; c < 3; ++c) value[c] *= normal(random);
    return value;
  };
}

void expect_parameters(const LobeModel& found, const LobeModel& truth, double tolerance, const std::string& what) {
  ASSERT_EQ(found.lobes.size(), truth.lobes.size()) << what;
  const detail::ParameterLayout layout(truth, true);
  LobeModel a = found, b = truth;
  const std::vector<double> x = layout.pack(a), y = layout.pack(b);
  for (int k = 0; k < layout.size(); ++k) {
    const auto& e = layout.entries()[k];
    const double scale_x = e.parameter->logarithmic ? std::exp(x[k]) : x[k];
    const double scale_y = e.parameter->logarithmic ? std::exp(y[k]) : y[k];
    EXPECT_NEAR(scale_x, scale_y, tolerance * scale_y)
        << what << ": lobe " << e.lobe << " " << e.parameter->name << " channel " << e.channel;
  }
}

const std::vector<std::string>& models() {
  static const std::vector<std::string> all = {
      "lambert:albedo=0.5/0.3/0.1",
      "oren_nayar:sigma=0.6,albedo=0.3",
      "burley:roughness=0.8,albedo=0.6",
      "ggx:alpha=0.1,F0=0.9/0.7/0.4",
      "lambert:albedo=0.5/0.3/0.1+ggx:alpha=0.15,F0=0.05",
      "lambert:albedo=0.2+beckmann:alpha=0.3,F0=0.05",
      "lambert:albedo=0.2+student_t:alpha=0.1,gamma=1.8,F0=0.1/0.08/0.06",
      "lambert:albedo=0.2+blinn_phong:exponent=120,F0=0.1",
      "lambert:albedo=0.2+ward:alpha=0.12,F0=0.1",
      "lambert:albedo=0.2+ashikhmin_shirley:exponent=200,F0=0.1",
      "lambert:albedo=0.2+lafortune:exponent=40,spread=1.05,F0=0.1",
      "default",
      "lambert:albedo=0.1+ggx:alpha=0.3,F0=0.1+beckmann:alpha=0.05,F0=0.05",
  };
  return all;
}

TEST(Fit, RecoversEveryModelWithoutNoise) {
  for (const std::string& text : models()) {
    const LobeModel truth = parse_model(text);
    expect_parameters(fit(exact(truth), truth).model, truth, 0.01, text);
  }
}

TEST(Fit, RecoversEveryModelFromTwoPercentNoise) {
  for (const std::string& text : models()) {
    const LobeModel truth = parse_model(text);
    expect_parameters(fit(noisy(truth), truth).model, truth, 0.05, text);
  }
}

// The least standard deviation that an unbiased fit of eta and k can have (Cramer-Rao), relative, for
// 2 % of independent noise on every value inside the cut-off; red channel of a lobe alone.
glm::dvec2 conductor_bound(const Lobe& lobe, double cutoff) {
  FitOptions options;
  options.grazing_cutoff = cutoff;
  const LobeModel model{"", {lobe}};
  const detail::ParameterLayout layout(model, false);
  const std::vector<double> x = layout.pack(model);
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  // Fisher's, of eta and k
  for (detail::FitSample sample : detail::fit_samples(exact(model), options)) {
    if (!(sample.value.r > 0)) continue;
    sample.weight = 1;
    const detail::SampleResidual residual(sample, layout, Compression::none);
    std::vector<double> jacobian(3 * x.size());
    const double* parameters[] = {x.data()};
    double residuals[3], *jacobians[] = {jacobian.data()};
    residual.Evaluate(parameters, residuals, jacobians);
    const Eigen::Vector2d slope(jacobian[1], jacobian[4]);  // alpha, eta rgb, k rgb
    information += slope * slope.transpose() / std::pow(0.02 * sample.value.r, 2);
  }
  const Eigen::Vector2d deviation = information.inverse().diagonal().cwiseSqrt();
  return {deviation[0], deviation[1] / lobe.color[1].r};
}

// Every eta and k comes back without noise. With it the reflectance does, and where the table
// determines them, eta and k. For the first metal it does not: no fit could be within 5 %.
TEST(Fit, RecoversConductors) {
  const LobeModel truth = parse_model("lambert:albedo=0.1+ggx:alpha=0.3,eta=0.3/0.9/1.2,k=3.5/2.5/2");
  expect_parameters(fit(exact(truth), truth).model, truth, 0.01, "conductor");
  const Lobe &lobe = truth.lobes[1], found = fit(noisy(truth), truth).model.lobes[1];
  EXPECT_NEAR(found.shape[0].r, 0.3, 0.005);
  for (int c = 0; c < 3; ++c) {
    for (double cos_d : {1.0, 0.7, 0.4}) {
      const double expected = conductor(lobe.color[0][c], lobe.color[1][c], cos_d);
      EXPECT_NEAR(conductor(found.color[0][c], found.color[1][c], cos_d), expected, 0.01 * expected);
    }
    if (c == 0) continue;
    EXPECT_NEAR(found.color[0][c], lobe.color[0][c], 0.05 * lobe.color[0][c]);
    EXPECT_NEAR(found.color[1][c], lobe.color[1][c], 0.05 * lobe.color[1][c]);
  }
  // The figures of docs/guide/fit.md.
  const auto expect_bound = [](Lobe metal, int channel, double cutoff, double eta, double k) {
    for (glm::dvec3& c : metal.color) c = glm::dvec3(c[channel]);
    const glm::dvec2 bound = conductor_bound(metal, cutoff * pi<double> / 180);
    EXPECT_NEAR(bound.x, eta, 0.0006);
    EXPECT_NEAR(bound.y, k, 0.0006);
  };
  expect_bound(lobe, 0, 75, 0.065, 0.036);
  expect_bound(lobe, 1, 75, 0.011, 0.006);
  expect_bound(lobe, 0, 88, 0.023, 0.013);
}

TEST(Fit, RecoversModelsFromTablesInMerlLayout) {
  struct Case {
    const char* text;
    double noise, tolerance;
  };
  for (const Case& c : {Case{"ggx:alpha=0.01,F0=0.02", 0, 0.001}, Case{"ggx:alpha=1,F0=1", 0, 0.001},
                        Case{"beckmann:alpha=0.02,F0=1", 0, 0.001}, Case{"beckmann:alpha=1,F0=0.02", 0, 0.001},
                        Case{"lambert:albedo=0.5/0.3/0.1+ggx:alpha=0.15,F0=0.05", 0, 0.01}, Case{"default", 0, 0.01},
                        Case{"default", 0.02, 0.05}}) {
    const LobeModel truth = parse_model(c.text);
    SynthOptions options;
    options.noise_sigma = c.noise;
    const MerlTable table(synthesize_merl(truth, options), {});
    const BrdfFunction f = [&](const glm::vec3& wi, const glm::vec3& wo) { return table.eval(wi, wo); };
    expect_parameters(fit(f, truth).model, truth, c.tolerance,
                      std::string(c.text) + " noise " + std::to_string(c.noise));
  }
}

// Cells of one degree blur a narrow lobe.
TEST(Fit, RecoversGgxFromAGrid) {
  for (const auto& [alpha, tolerance] : {std::pair{0.03, 0.03}, {0.1, 0.005}, {1.0, 0.001}})
    for (const double f0 : {0.02, 1.0}) {
      const LobeModel truth = parse_model("ggx:alpha=" + std::to_string(alpha) + ",F0=" + std::to_string(f0));
      const MbsdfTable table(synthesize_mbsdf(truth));
      const Lobe found =
          fit([&](const glm::vec3& wi, const glm::vec3& wo) { return table.eval(wi, wo); }, truth).model.lobes[0];
      EXPECT_NEAR(found.shape[0].r / alpha, 1, tolerance) << f0;
      EXPECT_NEAR(found.color[0].r / f0, 1, tolerance) << alpha;
    }
}

TEST(Fit, DerivativesAgreeWithDifferences) {
  const glm::dvec3 wi(std::sin(0.5), 0, std::cos(0.5));
  const glm::dvec3 wo(-std::sin(0.7) * std::cos(0.1), std::sin(0.7) * std::sin(0.1), std::cos(0.7));
  const detail::FitSample sample{Angles<double>(wi, wo), glm::dvec3(0.2, 0.4, 0.6), 0.7};
  for (LobeKind kind : lobe_kinds()) {
    for (Fresnel fresnel : {Fresnel::schlick, Fresnel::conductor}) {
      for (bool separate : {false, true}) {
        for (Compression compression : {Compression::none, Compression::cube_root, Compression::log}) {
          LobeModel model;
          model.lobes = {Lobe::initial(LobeKind::lambert), Lobe::initial(kind, fresnel)};
          const detail::ParameterLayout layout(model, separate);
          const detail::SampleResidual residual(sample, layout, compression);
          std::vector<double> x = layout.pack(model);
          ceres::NumericDiffOptions options;
          options.ridders_relative_initial_step_size = 1e-4;
          const std::vector<const ceres::Manifold*>* flat = nullptr;
          const ceres::GradientChecker checker(&residual, flat, options);
          const double* parameters[] = {x.data()};
          ceres::GradientChecker::ProbeResults results;
          EXPECT_TRUE(checker.Probe(parameters, 1e-4, &results)) << lobe_info(kind).id << ": " << results.error_log;
        }
      }
    }
  }
}

TEST(Fit, MoreLobesNeverFitWorse) {
  // Lobes that the fitted ones cannot be: every stage has something left to gain or to lose.
  const LobeModel truth = parse_model(
      "burley:albedo=0.2,roughness=0.9+student_t:alpha=0.1,gamma=1.6,F0=0.1+lafortune:exponent=9,"
      "F0=0.2");
  FitOptions coarse;
  coarse.theta_h = 30;
  coarse.theta_d = 6;
  for (const char* form :
       {"lambert+ggx+ggx+ggx", "lambert+blinn_phong+ggx+ward", "lambert+ggx:eta=1+ggx:eta=1+ggx:eta=1"}) {
    const std::vector<Fit> fits = fit_stages(exact(truth), parse_model(form), coarse);
    ASSERT_EQ(fits.size(), 3u);
    for (size_t k = 1; k < fits.size(); ++k) {
      EXPECT_LE(fits[k].summary.cost, fits[k - 1].summary.cost) << form;
      EXPECT_EQ(fits[k].model.specular_count(), static_cast<int>(k) + 1);
    }
  }
}

TEST(Fit, IsDeterministic) {
  const LobeModel truth = parse_model("default");
  const Fit a = fit(noisy(truth), truth), b = fit(noisy(truth), truth);
  EXPECT_EQ(describe(a.model), describe(b.model));
  EXPECT_EQ(a.summary.costs, b.summary.costs);
}

TEST(Fit, SummaryTellsHowItWent) {
  const LobeModel truth = parse_model("lambert:albedo=0.4+ggx:alpha=0.2");
  const FitSummary s = fit(exact(truth), truth).summary;
  EXPECT_EQ(s.termination, Termination::converged);
  EXPECT_STREQ(to_string(s.termination), "converged");
  EXPECT_GT(s.iterations, 0);
  EXPECT_LT(s.cost, 1e-8);
  EXPECT_LE(s.cost, s.initial_cost);
  EXPECT_EQ(s.costs.size(), 4u);
  EXPECT_GE(s.agreeing_starts, 1);
  EXPECT_GT(s.samples, 2000);
  ASSERT_EQ(s.parameters.size(), 10u);
  EXPECT_EQ(s.parameters[3].name, "1.ggx.alpha");
  EXPECT_NEAR(s.parameters[3].value, 0.2, 1e-3);
  EXPECT_LE(s.parameters[3].min, s.parameters[3].value);
  EXPECT_GE(s.parameters[3].max, s.parameters[3].value);

  FitOptions short_run;
  short_run.max_iterations = 1;
  EXPECT_EQ(fit(noisy(truth), truth, short_run).summary.termination, Termination::iteration_limit);
}

TEST(FitOptions, SeparateChannelsFindWidthsOfTheirOwn) {
  const LobeModel truth = parse_model("lambert:albedo=0.2+ggx:alpha=0.1/0.2/0.4,F0=0.1");
  FitOptions options;
  options.separate_channels = true;
  expect_parameters(fit(exact(truth), truth, options).model, truth, 0.01, "separate");
  EXPECT_GT(fit(exact(truth), truth).summary.cost, 1e-5);  // one width cannot do it
}

TEST(FitOptions, EveryCompressionAndWeighting) {
  const LobeModel truth = parse_model("lambert:albedo=0.3+ggx:alpha=0.12,F0=0.08");
  for (Compression compression : {Compression::none, Compression::cube_root, Compression::log}) {
    for (bool weights : {false, true}) {
      FitOptions options;
      options.compression = compression;
      options.solid_angle_weights = weights;
      expect_parameters(fit(exact(truth), truth, options).model, truth, 0.01, "compression");
    }
  }
}

TEST(FitOptions, RobustLossIgnoresOutliers) {
  const LobeModel truth = parse_model("lambert:albedo=0.3+ggx:alpha=0.15,F0=0.08");
  int calls = 0;
  const BrdfFunction f = [&](const glm::vec3& wi, const glm::vec3& wo) {
    return truth.eval(wi, wo) * (++calls % 50 == 0 ? 30.0f : 1.0f);
  };
  const auto albedo_error = [&](double width) {
    FitOptions options;
    options.robust_width = width;
    calls = 0;
    return std::fabs(fit(f, truth, options).model.lobes[0].color[0].g / 0.3 - 1);
  };
  EXPECT_LT(albedo_error(0.01), 0.02);
  EXPECT_GT(albedo_error(0), 0.04);
}

TEST(FitOptions, NothingBeyondTheCutoffIsLookedAt) {
  const LobeModel truth = parse_model("lambert:albedo=0.3+ggx:alpha=0.15,F0=0.08");
  const float lowest = std::cos(60 * pi<float> / 180);
  const BrdfFunction f = [&](const glm::vec3& wi, const glm::vec3& wo) {
    return wi.z < lowest - 1e-5f || wo.z < lowest - 1e-5f ? glm::vec3(100) : truth.eval(wi, wo);
  };
  FitOptions options;
  options.grazing_cutoff = 60 * pi<double> / 180;
  expect_parameters(fit(f, truth, options).model, truth, 0.01, "cut-off");
  EXPECT_GT(fit(f, truth).summary.cost, 1e-3);  // the default looks further
}

// Cells that a table made up do not count: a table measured to some angle gives what a cut-off at that
// angle gives, and its holes cost nothing.
TEST(Fit, LooksAtMeasuredCellsAlone) {
  const LobeModel truth = parse_model("lambert:albedo=0.2+ggx:alpha=0.3,F0=0.5");
  const auto expect_found = [&](const BrdfTable& table, const std::string& what) {
    const Lobe diffuse = truth.lobes[0], lobe = truth.lobes[1];
    const LobeModel found = fit(measured_part(table), truth).model;
    EXPECT_NEAR(found.lobes[0].color[0].g, diffuse.color[0].g, 0.002) << what;
    EXPECT_NEAR(found.lobes[1].shape[0].g, lobe.shape[0].g, 0.003) << what;
    EXPECT_NEAR(found.lobes[1].color[0].g, lobe.color[0].g, 0.005) << what;
  };
  for (const double to : {20.0, 30.0, 60.0}) {
    SynthOptions options;
    options.measured_to = to * pi<double> / 180;
    expect_found(BrdfTable(MerlTable(synthesize_merl(truth, options), {}), {}), "MERL");
    for (const CellPolicy policy : {CellPolicy::fill, CellPolicy::zero}) {
      const CellPolicies policies{CellPolicy::zero, policy, policy};
      expect_found(BrdfTable(MbsdfTable(synthesize_mbsdf(truth, 90, 180, options), policies), {}), "MBSDF");
    }
  }
  MbsdfFile holes = synthesize_mbsdf(truth, 90, 180);
  std::mt19937 random(1);
  for (std::size_t k = 0; k < holes.values.size(); k += 3)
    if (random() % 8 == 0) holes.values[k] = std::numeric_limits<float>::infinity();
  expect_found(BrdfTable(MbsdfTable(holes), {}), "holes");

  SynthOptions nothing;
  nothing.measured_to = 1e-9;
  MbsdfFile one = synthesize_mbsdf(truth, 10, 10, nothing);
  for (int c = 0; c < 3; ++c) one.values[c] = 0.1f;
  try {
    fit(measured_part(BrdfTable(MbsdfTable(one), {})), truth);
    ADD_FAILURE() << "one cell was enough";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no pair of directions within 75 degrees"), std::string::npos)
        << error.what();
  }
}

TEST(FitOptions, OutOfRangeIsRefused) {
  const LobeModel form = parse_model("lambert");
  const auto refused = [&](void (*change)(FitOptions&), const std::string& field) {
    FitOptions options;
    change(options);
    try {
      fit(exact(form), form, options);
      ADD_FAILURE() << field << " was accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  refused([](FitOptions& o) { o.grazing_cutoff = 2; }, "grazing_cutoff");
  refused([](FitOptions& o) { o.robust_width = -1; }, "robust_width");
  refused([](FitOptions& o) { o.starts = 0; }, "starts");
  refused([](FitOptions& o) { o.max_iterations = 0; }, "max_iterations");
  refused([](FitOptions& o) { o.theta_h = 1; }, "theta_h");
  refused([](FitOptions& o) { o.theta_d = 1; }, "theta_d");
  refused([](FitOptions& o) { o.phi_d = 1; }, "phi_d");
}

TEST(Fit, RefusesNothingToFit) {
  const BrdfFunction black = [](const glm::vec3&, const glm::vec3&) { return glm::vec3(0); };
  EXPECT_THROW(fit(black, parse_model("lambert")), Error);
  EXPECT_THROW(fit(exact(parse_model("lambert")), LobeModel{}), Error);
}

TEST(NonNegativeLeastSquares, StopsAtZero) {
  // min (x + y - 1)^2 + (x - y - 3)^2: free optimum (2, -1), with y >= 0 it is (2, 0).
  const Eigen::VectorXd x = detail::non_negative_least_squares(Eigen::Matrix2d{{1, 1}, {1, -1}}, Eigen::Vector2d(1, 3));
  EXPECT_NEAR(x[0], 2, 1e-12);
  EXPECT_EQ(x[1], 0);
}

}  // namespace
}  // namespace gonio
