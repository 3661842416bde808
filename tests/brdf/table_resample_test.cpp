#include <gtest/gtest.h>

#include <gonio/brdf/resample/table_resample.h>
#include <gonio/brdf/table/albedo.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;

float radians(double degrees) { return static_cast<float>(degrees * pi / 180); }

TEST(Write, LambertianStaysWhatItWas) {
  const BrdfTable table(MbsdfTable(MbsdfFile{1, 1, 1, 3, {0.1f, 0.2f, 0.3f}, "", false}), {});
  for (const int n_phi_d : {180, 360}) {
    const MerlFile merl = sample_as_merl(table, n_phi_d);
    const MerlTable read(merl, {});
    EXPECT_EQ(read.cells().missing, 0u) << "marks lie below the horizon alone";
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(read.eval(direction(0.5, 0), direction(1.2, 2))[c], 0.1 * (c + 1), 1e-6);
    }
  }
  const MbsdfTable grid(sample_as_mbsdf(table, 5, 6));
  EXPECT_NEAR(grid.eval(direction(0.5, 0), direction(1.2, 2)).b, 0.3, 1e-6);
  EXPECT_THROW(sample_as_merl(table, 90), Error);
  EXPECT_THROW(sample_as_mbsdf(table, 0, 3), Error);
}

TEST(Write, MerlOfMerlIsTheSame) {
  const MerlFile file = make_merl([](int h, int d, int p) { return 1.0 + (h * 7 + d * 3 + p) % 5; });
  const MerlFile again = sample_as_merl(BrdfTable(MerlTable(file, {}), {}), 180);
  int compared = 0;
  for (std::size_t i = 0; i < file.values.size(); i += 101) {
    if (again.values[i] < 0.0) continue;
    // Within the rounding of the angles times the steepness of this table.
    EXPECT_NEAR(again.values[i] / file.values[i], 1.0, 0.02) << i;
    ++compared;
  }
  EXPECT_GT(compared, 10000);
}

// f_r depends on theta_in alone: not reciprocal.
TEST(Write, ReciprocalLayoutAverages) {
  const BrdfTable table(MbsdfTable(MbsdfFile{2, 1, 1, 1, {0.0f, 1.0f}, "", false}), {});
  const BrdfTable half(MerlTable(sample_as_merl(table, 180), {}), {});
  const BrdfTable full(MerlTable(sample_as_merl(table, 360), {}), {});
  const glm::vec3 low = direction(1.4, 0.0), high = direction(0.2, 1.0);
  EXPECT_NEAR(half.eval(low, high).r, 0.5f, 0.01f);
  EXPECT_NEAR(half.eval(high, low).r, 0.5f, 0.01f);
  EXPECT_NEAR(full.eval(low, high).r, 1.0f, 0.02f);
  EXPECT_NEAR(full.eval(high, low).r, 0.0f, 0.02f);
}

TEST(Write, GridKeepsItsCells) {
  MbsdfFile file{3, 3, 4, 3, {}, "", false};
  for (int i = 0; i < 108; ++i) file.values.push_back(static_cast<float>(i));
  const BrdfTable table{MbsdfTable(file), {}};
  const MbsdfFile again = sample_as_mbsdf(table, 3, 4);
  ASSERT_EQ(again.values.size(), file.values.size());
  for (std::size_t i = 0; i < file.values.size(); ++i) {
    EXPECT_NEAR(again.values[i], file.values[i], 1e-3);
  }
}

TEST(Write, MeasuredAlbedosSurviveMerl) {
  if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const TemporaryFolder folder;
  for (const char* name : {"cc_iris_purple_gem_rgb", "cg_sunflower_rgb", "paper_white_rgb", "satin_rosaline_rgb"}) {
    const BrdfTable table = load_table(test_data() / "rgl" / (std::string(name) + ".bsdf"));
    write_table_as_merl(table, folder / "m.binary");
    const BrdfTable merl = load_table(folder / "m.binary");
    for (const double degrees : {2, 10, 30, 50, 70, 80, 85}) {
      const float expected = luminance(directional_albedo(table, radians(degrees)));
      const float found = luminance(directional_albedo(merl, radians(degrees)));
      EXPECT_NEAR(found / expected, 1.0f, 0.01f) << name << " at " << degrees;
    }
  }
}

TEST(Write, NothingIsLeftAfterAFailure) {
  const TemporaryFolder folder;
  const BrdfTable table(MbsdfTable(MbsdfFile{1, 1, 1, 1, {0.1f}, "", false}), {});
  EXPECT_THROW(write_table_as_mbsdf(table, folder.path() / "no" / "x.mbsdf", 2, 2), Error);
  write_file(folder / "old", "old");
  MerlFile bad;
  EXPECT_THROW(write_merl(folder / "old", bad), Error);
  EXPECT_EQ(file_bytes(folder / "old"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace gonio
