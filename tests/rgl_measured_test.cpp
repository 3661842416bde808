// Real materials through the writer and back: slow, since stacks are built.

#include <gonio/brdf/fit_compact.h>
#include <gonio/brdf/rgl_write.h>
#include <gonio/brdf/validate.h>
#include <gonio/fitting/synth.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "rgl_quality.h"
#include "table_files.h"

namespace gonio {
namespace {

using namespace test;

void expect_close(const std::string& name, const Reflectance& f_r) {
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
  EXPECT_LT(mean, 0.01);
  EXPECT_LT(worst, 0.025);
  EXPECT_GT(least, 0.998);
  EXPECT_LT(largest, 1.002);
}

class Measured : public testing::TestWithParam<const char*> {};

// RGL, then a stack with colours of its own, then RGL.
TEST_P(Measured, StackToRgl) {
  if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const BrdfTable table = load_table(test_data() / "rgl" / (std::string(GetParam()) + "_rgb.bsdf"));
  const CompactBsdf bsdf = fit_compact(table).best().bsdf();
  expect_close(GetParam(), [&](const glm::vec3& wi, const glm::vec3& wo) { return bsdf.eval(wi, wo); });
}

INSTANTIATE_TEST_SUITE_P(Rgl, Measured,
                         testing::Values("satin_rosaline"),
                         [](const auto& test) { return std::string(test.param); });

TEST(RglOfMerl, SynthesisedTable) {
  const BrdfTable table(MerlTable(synthesize_merl(parse_model("default")), {}), {});
  expect_close("default", [&](const glm::vec3& wi, const glm::vec3& wo) { return table.eval(wi, wo); });
}

}  // namespace
}  // namespace gonio
