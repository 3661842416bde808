// Real materials through the writer and back: slow, since stacks are built.

#include <algorithm>
#include <cstdio>
#include <ostream>

#include <gtest/gtest.h>

#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/formats/rgl/rgl_write.h>
#include <gonio/brdf/table/validate.h>
#include <gonio/fitting/model/synth.h>

#include "tests/support/rgl_quality.h"
#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;

// Of the errors, mean and worst over the angles. docs/guide/renderers.md says where they come from.
struct Bounds {
  double mean = 0.01, worst = 0.025;
};

void expect_close(const std::string& name, const Reflectance& f_r, const Bounds& bounds = {}) {
  const TemporaryFolder folder;
  write_rgl(folder / "a.bsdf", resample_as_rgl(f_r, name));
  for (const Problem& problem : validate_table(folder / "a.bsdf")) {
    EXPECT_FALSE(problem.fatal) << problem.field << ": " << problem.found;
  }
  const RglTable table(read_rgl(folder / "a.bsdf"), {});
  const double angles[] = {2, 10, 17.3, 30, 41, 50, 61, 70, 75.3, 80, 85};
  double mean = 0, worst = 0, least = 1, largest = 1;
  for (const double degrees : angles) {
    const RglQuality quality = measure(table, f_r, degrees);
    mean += quality.error / std::size(angles);
    worst = std::max(worst, quality.error);
    least = std::min(least, quality.integral);
    largest = std::max(largest, quality.integral);
  }
  std::printf("%s: error mean %.4f, worst %.4f; pdf integrates to %.4f to %.4f; %zu angles, %ju bytes\n", name.c_str(),
              mean, worst, least, largest, table.theta_i().size(), std::filesystem::file_size(folder / "a.bsdf"));
  EXPECT_LT(mean, bounds.mean);
  EXPECT_LT(worst, bounds.worst);
  EXPECT_GT(least, 0.998);
  EXPECT_LT(largest, 1.002);
}

struct Material {
  const char* name;
  Bounds bounds;
};

void PrintTo(const Material& material, std::ostream* out) { *out << material.name; }

class Measured : public testing::TestWithParam<Material> {
 protected:
  void SetUp() override {
    if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  }
};

std::string name_of(const testing::TestParamInfo<Material>& test) { return test.param.name; }

// RGL, then a stack with colours of its own, then RGL.
class MeasuredRgl : public Measured {};

TEST_P(MeasuredRgl, StackToRgl) {
  const auto& [name, bounds] = GetParam();
  const BrdfTable table = load_table(test_data() / "rgl" / (std::string(name) + "_rgb.bsdf"));
  const Bsdf bsdf(fit_compact(table).best().data);
  expect_close(
      name, [&](const glm::vec3& wi, const glm::vec3& wo) { return bsdf.eval(wi, wo); }, bounds);
}

INSTANTIATE_TEST_SUITE_P(Rgl, MeasuredRgl,
                         testing::Values(Material{"satin_rosaline", {}}, Material{"cg_sunflower", {0.01, 0.032}}),
                         name_of);

// These stay above 1 %, as measured: bounds that a change for the worse breaks.
class MeasuredMbsdf : public Measured {};

TEST_P(MeasuredMbsdf, TableToRgl) {
  const auto& [name, bounds] = GetParam();
  const BrdfTable table = load_table(test_data() / "mbsdf" / (std::string(name) + ".mbsdf"));
  expect_close(
      name, [&](const glm::vec3& wi, const glm::vec3& wo) { return table.eval(wi, wo); }, bounds);
}

INSTANTIATE_TEST_SUITE_P(CarPaint, MeasuredMbsdf,
                         testing::Values(Material{"carpaint_blue", {0.023, 0.085}},
                                         Material{"carpaint_red", {0.075, 0.2}}),
                         name_of);

TEST(RglOfMerl, SynthesisedTable) {
  const BrdfTable table(MerlTable(synthesize_merl(parse_model("default")), {}), {});
  expect_close("default", [&](const glm::vec3& wi, const glm::vec3& wo) { return table.eval(wi, wo); });
}

}  // namespace
}  // namespace gonio
