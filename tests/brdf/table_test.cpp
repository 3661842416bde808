#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/table/flat_from.h>
#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string message(const std::filesystem::path& path, const CellPolicies& policies = {}) {
  try {
    load_table(path, policies);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Table, RecognisedByContentWhateverTheName) {
  const TemporaryFolder folder;
  write_merl(folder / "a.bsdf", make_merl([](int, int, int) { return 1.0; }));
  write_file(folder / "b.mbsdf", make_rgl().bytes());
  write_file(folder / "c.binary", make_mbsdf(0, 2, 3, std::vector<float>(12, 1.0f)));
  const BrdfTable merl = load_table(folder / "a.bsdf"), rgl = load_table(folder / "b.mbsdf"),
                  grid = load_table(folder / "c.binary");
  EXPECT_EQ(merl.info().format, "merl");
  EXPECT_EQ(rgl.info().format, "rgl");
  EXPECT_EQ(grid.info().format, "mbsdf");
  EXPECT_EQ(rgl.info().description, "uniform");
  EXPECT_EQ(merl.info().name, "a");
  EXPECT_EQ(merl.info().source_bytes, 34992012u);
  EXPECT_EQ(merl.info().cells.total, 90u * 90 * 180);
  const glm::vec3 wi = direction(0.4, 0.0), wo = direction(0.9, 2.0);
  EXPECT_NEAR(merl.eval(wi, wo).g, 1.0f, 1e-5);
  EXPECT_NEAR(rgl.eval(wi, wo).g * wo.z, 0.2f, 1e-5);
  EXPECT_NEAR(grid.eval(wi, wo).g, 1.0f, 1e-5);
}

TEST(Table, ZeroAtAndBelowTheHorizonAndNeverNaN) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  const TemporaryFolder folder;
  write_merl(folder / "merl", make_merl([](int, int, int) { return 1.0; }));
  write_file(folder / "rgl", make_rgl().bytes());
  write_file(folder / "grid", make_mbsdf(0, 1, 1, {1.0f}));
  for (const char* name : {"merl", "rgl", "grid"}) {
    const BrdfTable table = load_table(folder / name);
    const glm::vec3 up = direction(0.5, 1.0);
    EXPECT_GT(table.eval(up, up).r, 0.0f);
    EXPECT_GT(table.eval({0, 0, 1}, {0, 0, 1}).r, 0.0f);
    for (const glm::vec3 down : {glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), direction(1.8, 0.0)}) {
      EXPECT_EQ(table.eval(up, down), glm::vec3(0.0f));
      EXPECT_EQ(table.eval(down, up), glm::vec3(0.0f));
    }
    for (const glm::vec3 odd :
         {glm::vec3(nan, 0, 1), glm::vec3(0, nan, 1), glm::vec3(0, 0, nan), glm::vec3(inf, 0, 1), glm::vec3(0, 0, inf),
          glm::vec3(0, 0, 1e-40f), glm::vec3(1, 0, 1e-40f), glm::vec3(-1, 0, 1e-30f)}) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_FALSE(std::isnan(table.eval(odd, up)[c])) << name;
        EXPECT_FALSE(std::isnan(table.eval(up, odd)[c])) << name;
        EXPECT_FALSE(std::isnan(table.eval(odd, odd)[c])) << name;
      }
    }
  }
}

TEST(Table, WhatIsNoTableIsNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT(message(folder / "none"), AllOf(HasSubstr("none: no such file")));
  EXPECT_THAT(message(folder.path()), HasSubstr("found a folder, expected a file"));
  write_file(folder / "empty", "");
  EXPECT_THAT(message(folder / "empty"), HasSubstr("empty: format: found an empty file"));
  write_file(folder / "text", "<?xml version=\"1.0\"?>");
  EXPECT_THAT(message(folder / "text"), HasSubstr("starts with \"<?xml version=\"1\""));
  std::string other;
  for (const std::int32_t n : {2, 3, 4}) append(other, n);
  write_file(folder / "merl", other + std::string(24 * 24, '\0'));
  EXPECT_THAT(message(folder / "merl"), HasSubstr("dimensions: found 2 x 3 x 4"));
}

TEST(Table, PolicyErrorsNameTheFile) {
  const TemporaryFolder folder;
  write_file(folder / "x", make_mbsdf(0, 1, 2, {-1.0f, 1.0f}));
  CellPolicies policies;
  policies.negative = CellPolicy::reject;
  EXPECT_EQ(message(folder / "x"), "no error");
  EXPECT_THAT(message(folder / "x", policies),
              AllOf(HasSubstr((folder / "x").string()), HasSubstr("cells: found 1 negative of 2")));
}

TEST(Table, EveryMeasuredFileLoads) {
  if (test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  int files = 0;
  for (const char* name : {"rgl", "rgl_more", "mbsdf"}) {
    for (const auto& entry : std::filesystem::directory_iterator(test_data() / name)) {
      const std::filesystem::path& path = entry.path();
      const bool paint = path.filename().string().rfind("carpaint", 0) == 0;
      if (path.extension() != ".bsdf" && !paint) continue;
      ++files;
      EXPECT_NO_THROW(load_table(path)) << path;
      // Rounding noise in one file of the database; the carpaints repeat their cell at 67 degrees.
      if (path.stem() == "ilm_solo_m_68_rgb") {
        const BrdfTable table = load_table(path);
        EXPECT_EQ(std::get<RglTable>(table.data()).densities().negative, 16u);
      }
      if (paint) {
        EXPECT_NEAR(flat_from(load_table(path)).theta_i, 67, 1) << path;
      }
    }
  }
  EXPECT_EQ(files, 12);
}

}  // namespace
}  // namespace gonio
