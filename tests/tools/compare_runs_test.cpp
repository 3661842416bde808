#include "tools/render/compare/compare_runs.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/error.h>

#include "tools/render/image/difference.h"
#include "tools/render/scene/read_scene.h"

namespace gonio {
namespace {

/// A plate under a sky.
Scene plate(const char* model = "ggx:alpha=0.15,F0=0.9") {
  Scene scene = make_scene(nlohmann::json::parse(R"({
    "camera": {"position": [0, -5, 4], "target": [0, 0, 0], "vertical_fov": 10, "resolution": [12, 12]},
    "environment": {"sky": {"sun": [0, 1, 1], "radiance": 5, "radius": 20}},
    "materials": {"a": {"albedo": 0.5}}, "objects": [{"shape": "square", "material": "a", "scale": [1, 3, 1], "translate": [0.9, 0, 0]}]})"),
                           "test", {});
  scene.materials[0].bsdf = nullptr;
  scene.materials[0].table = std::make_shared<const BrdfTable>(MbsdfTable(synthesize_mbsdf(parse_model(model), 24, 48)),
                                                               BrdfTable::Info{"test", "test", "mbsdf", "", 0, {}});
  return scene;
}

TEST(CompareMethods, GivesCurvesAndFindsCosineSamplingWorse) {
  const Scene scene = plate();
  CompareOptions options;
  options.methods = {SamplingMethod::automatic, SamplingMethod::cosine};
  options.seconds = 0.15;
  options.reference_seconds = 1;
  const Comparison c = compare_methods(scene, options);
  EXPECT_GT(c.pixels, 30u);  // the plate fills a part of the view
  EXPECT_LT(c.pixels, 144u);
  ASSERT_EQ(c.runs.size(), 4u);
  std::vector<double> at_equal_samples;
  for (const CompareRun& run : c.runs) {
    ASSERT_FALSE(run.convergence.empty());
    EXPECT_EQ(run.convergence.front().samples, 1);
    for (std::size_t k = 1; k < run.convergence.size(); ++k) {
      EXPECT_GT(run.convergence[k].samples, run.convergence[k - 1].samples);
      EXPECT_GE(run.convergence[k].seconds, run.convergence[k - 1].seconds);
    }
    EXPECT_EQ(run.image.pixels.size(), 144u);
    for (const ConvergencePoint& p : run.convergence)
      if (p.samples == c.equal_samples) at_equal_samples.push_back(p.relmse);
  }
  ASSERT_EQ(at_equal_samples.size(), 4u);
  EXPECT_EQ(c.runs[1].method, SamplingMethod::cosine);
  EXPECT_EQ(c.runs[3].strategy, Strategy::bsdf);
  EXPECT_GT(at_equal_samples[3], 3 * at_equal_samples[2]);
}

// A reference of two samples: its own error is what a run of many is away from it, and is not counted as the run's.
TEST(CompareMethods, TheErrorOfTheReferenceIsKnownAndSubtracted) {
  Scene scene = plate("lambert:albedo=0.5");
  scene.camera.vertical_fov = 0.02f;  // nothing but the plate
  scene.camera.target = {0.9f, 0, 0};
  scene.environment = std::make_shared<const Environment>(RgbImage{2, 1, {glm::vec3(1), glm::vec3(1)}}, "test");
  CompareOptions options;
  options.methods = {SamplingMethod::cosine};
  options.seconds = 0.5;
  options.reference_seconds = 1e-9;
  const Comparison c = compare_methods(scene, options);
  ASSERT_EQ(c.pixels, c.reference.pixels.size());
  std::vector<std::size_t> all(c.pixels);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const double distance = relative_error(c.runs[0].image, c.reference, all).relmse;
  EXPECT_GT(c.reference_relmse, 0.01);
  EXPECT_NEAR(distance / c.reference_relmse, 1, 0.3);
  EXPECT_NEAR(c.runs[0].convergence.back().relmse, std::max(distance - c.reference_relmse, 0.0), 1e-9);
}

TEST(CompareMethods, NeedsATableOrAStackFile) {
  Scene scene = plate();
  scene.materials[0].table = nullptr;
  CompareOptions options;
  options.methods = {SamplingMethod::cosine};
  EXPECT_THROW(compare_methods(scene, options), Error);
}

}  // namespace
}  // namespace gonio
