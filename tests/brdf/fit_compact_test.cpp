#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/proof/measure.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

std::shared_ptr<const BrdfTable> synthetic(const std::string& model, int thetas = 30, int phis = 36) {
  MbsdfFile file = synthesize_mbsdf(parse_model(model), thetas, phis);
  const std::size_t bytes = file.values.size() * sizeof(float);
  return std::make_shared<const BrdfTable>(BrdfTable(MbsdfTable(file), {"made", "made", "mbsdf", "", bytes, {}}));
}

std::shared_ptr<const BrdfTable> glossy() {
  static const auto table = synthetic("ggx+lambert:alpha=0.2,F0=0.3,albedo=0.3/0.2/0.1");
  return table;
}

// Measured by the report's own measure, not by the estimates of the optimiser.
TEST(FitCompact, ReachesTheVarianceAskedFor) {
  BsdfOptions options;
  options.max_variance = 0.01;
  const CompactFit fit = fit_compact(*glossy(), options).best();
  EXPECT_EQ(fit.data.interpolation, Interpolation::blend);
  EXPECT_EQ(fit.bytes, BatchLayout(sampled_stack(fit.data)).bytes() + fit.data.colour.bytes());
  EXPECT_LE(fit.quality.worst_relvar, 0.01);
  const Bsdf bsdf(fit.data, glossy());
  for (const double theta : {2.0, 10.0, 30.0, 50.0, 70.0, 80.0})
    EXPECT_LE(proof::measure(proof::subject_of(bsdf), theta * degree).relvar, 0.011) << theta;
}

TEST(FitCompact, MoreVarianceTakesFewerBytes) {
  std::size_t before = SIZE_MAX;
  for (const double variance : {0.001, 0.01, 0.1}) {
    BsdfOptions options;
    options.max_variance = variance;
    const std::size_t bytes = fit_compact(*glossy(), options).best().bytes;
    EXPECT_LT(bytes, before) << variance;
    before = bytes;
  }
}

TEST(FitCompact, StaysWithinTheBudget) {
  double before = 1e9;
  for (const std::size_t budget : {4 * 1024, 64 * 1024}) {
    BsdfOptions options;
    options.max_variance.reset();
    options.budget = budget;
    const CompactFit fit = fit_compact(*glossy(), options).best();
    EXPECT_LE(fit.bytes, budget);
    EXPECT_LT(fit.quality.eval_error, before);
    before = fit.quality.eval_error;
  }
  EXPECT_LT(before, 0.02);
}

// What cannot be had is not pretended.
TEST(FitCompact, SaysWhatItMissed) {
  BsdfOptions options;
  options.max_variance = 1e-6;
  options.budget = 8 * 1024;
  const CompactFit fit = fit_compact(*glossy(), options).best();
  EXPECT_LE(fit.bytes, options.budget);
  EXPECT_GT(fit.quality.worst_relvar, *options.max_variance);
}

/// What it reports of its progress.
std::vector<double> progress_of(const BsdfOptions& options) {
  std::vector<double> reported{0};
  fit_compact(*synthetic("ggx+lambert:alpha=0.3,F0=0.3,albedo=0.3/0.2/0.1", 12, 16), options,
              [&](double share) { reported.push_back(share); });
  return reported;
}

// Whether the variance is within reach, out of it, or not asked for.
TEST(FitCompact, ProgressGrowsInSmallSteps) {
  BsdfOptions reached, missed, budget;
  reached.chart = budget.chart = Chart::outgoing;
  reached.max_variance = 0.01;
  missed.max_variance = 0.001;
  missed.budget = 2 * 1024;
  budget.max_variance.reset();
  budget.budget = 4 * 1024;
  for (const BsdfOptions& options : {reached, missed, budget}) {
    const std::vector<double> reported = progress_of(options);
    for (std::size_t k = 1; k < reported.size(); ++k) {
      EXPECT_GE(reported[k], reported[k - 1]);
      EXPECT_LT(reported[k] - reported[k - 1], 0.4) << reported[k - 1];
    }
    EXPECT_EQ(reported.back(), 1);
    // At the end and not before.
    EXPECT_LE(std::count(reported.begin(), reported.end(), 1.0), 2);
  }
}

TEST(FitCompact, DiffuseIsAFewHundredBytes) {
  BsdfOptions options;
  options.max_variance = 0.01;
  const CompactFit fit = fit_compact(*synthetic("lambert:albedo=0.5/0.4/0.3"), options).best();
  EXPECT_LT(fit.bytes, 600u);
  EXPECT_LT(fit.quality.eval_error, 0.02);
}

// Near the normal, a narrow lobe leaves its neighbours behind soonest: in the chart of outgoing directions its
// angles crowd there.
TEST(FitCompact, NearMirrorNeedsAnglesNearTheNormal) {
  BsdfOptions options;
  options.max_variance = 0.05;
  options.budget = 4 << 20;
  options.chart = Chart::outgoing;
  const auto table = std::make_shared<const BrdfTable>(BrdfTable(
      MerlTable(synthesize_merl(parse_model("ggx:alpha=0.06,F0=0.9")), {}), {"made", "made", "merl", "", 0, {}}));
  const CompactFit fit = fit_compact(*table, options).best();
  std::size_t low = 0, middle = 0;
  for (const double theta : fit.data.diagrams.theta_i) {
    if (theta < 15 * degree) ++low;
    if (theta >= 35 * degree && theta < 50 * degree) ++middle;
  }
  EXPECT_GT(low, middle);
}

TEST(FitCompact, TheSameEveryTime) {
  const CompactFit a = fit_compact(*glossy()).best(), b = fit_compact(*glossy()).best();
  ASSERT_EQ(a.data.diagrams.theta_i, b.data.diagrams.theta_i);
  for (std::size_t k = 0; k < a.data.diagrams.diagrams.size(); ++k)
    EXPECT_EQ(a.data.diagrams.diagrams[k].density, b.data.diagrams.diagrams[k].density);
  EXPECT_EQ(a.data.colour.values(), b.data.colour.values());
}

TEST(CompactCurve, BytesGoWhereTheMaterialIsSeen) {
  BsdfOptions grazing;
  grazing.incidence = std::vector<double>(90, 0.0);
  for (std::size_t k = 60; k < 80; ++k) grazing.incidence[k] = 0.05;
  const auto share_below_45 = [](const std::vector<CompactFit>& curve) {
    std::size_t low = 0, all = 0;
    for (const CompactFit& fit : curve) {
      for (const double theta : fit.data.diagrams.theta_i) low += theta < 45 * degree;
      all += fit.data.diagrams.theta_i.size();
    }
    return static_cast<double>(low) / static_cast<double>(all);
  };
  const std::vector<double> variances{0.01, 0.001};
  EXPECT_LT(share_below_45(compact_curve(*glossy(), variances, grazing)),
            share_below_45(compact_curve(*glossy(), variances)));
}

// More bytes never make it much worse: the search goes both ways, to fewer lines at more angles and back.
TEST(FitCompact, ErrorFallsWithTheBudget) {
  const auto narrow = synthetic("ggx:alpha=0.08,F0=0.3");
  double least = 1e9;
  for (const std::size_t budget : {1024, 2048, 4096, 8192}) {
    BsdfOptions options;
    options.max_variance.reset();
    options.budget = budget;
    const CompactFit fit = fit_compact(*narrow, options).best();
    EXPECT_LE(fit.bytes, budget);
    EXPECT_LT(fit.quality.eval_error, 1.15 * least) << budget;
    least = std::min(least, fit.quality.eval_error);
  }
  EXPECT_LT(least, 0.06);
}

// A normal with the azimuth of every wo at 0 once made all compact BSDFs of such tables too dark.
TEST(FitCompact, KeepsTheAlbedoAtTheNormal) {
  const CompactFit fit = fit_compact(*synthetic("ggx:alpha=0.08,F0=0.3")).best();
  EXPECT_LT(fit.quality.albedo_error, 0.01);
}

TEST(FitCompact, BlackTable) {
  const CompactFit fit = fit_compact(*synthetic("lambert:albedo=0")).best();
  EXPECT_LT(fit.bytes, 2000u);
  EXPECT_EQ(Bsdf(fit.data).eval({0, 0, 1}, {0, 0, 1}), glm::vec3(0));
}

TEST(FitCompact, RefusesBadOptions) {
  BsdfOptions options;
  options.max_variance = 0;
  EXPECT_THROW(fit_compact(*glossy(), options), Error);
  options.max_variance = 0.01, options.budget = 100;
  EXPECT_THROW(fit_compact(*glossy(), options), Error);
  EXPECT_THROW(compact_curve(*glossy(), {0.1, 0}), Error);
}

TEST(CompactCurve, FallsWithTheBytes) {
  const std::vector<CompactFit> curve = compact_curve(*glossy(), {0.1, 0.01, 0.001});
  ASSERT_GE(curve.size(), 2u);
  for (std::size_t k = 1; k < curve.size(); ++k) {
    EXPECT_GT(curve[k].bytes, curve[k - 1].bytes);
    EXPECT_LT(curve[k].quality.mean_relvar, curve[k - 1].quality.mean_relvar);
  }
}

}  // namespace
}  // namespace gonio
