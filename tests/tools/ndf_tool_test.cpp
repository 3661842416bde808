// Runs the verb ndf of the program GONIO_TOOL as a user does.

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <gonio/brdf/ndf/image/disk_image_file.h>

#include "tests/support/ndf_cases.h"
#include "tests/support/table_files.h"
#include "tests/support/tool_fixture.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class NdfTool : public test::ToolFixture {
 protected:
  int run(const std::string& arguments) const { return ToolFixture::run("ndf " + arguments); }
  json result(const std::string& folder) const { return json::parse(text(folder + "/ndf.json")); }

  /// Pictures, image files and texts are all there and not empty.
  void expect_files(const std::string& folder, bool profile) const {
    for (const char* name : {"ndf.exr", "g1.exr", "ndf.svg", "g1.svg", "ndf.json", "ndf.md"})
      EXPECT_GT(fs::file_size(folder_ / (folder + "/" + name)), 100u) << name;
    EXPECT_EQ(fs::exists(folder_ / (folder + "/profile.svg")), profile);
    for (const char* name : {"ndf.svg", "g1.svg"}) {
      EXPECT_NE(text(folder + "/" + name).find("contrast stretched"), std::string::npos);
      EXPECT_NE(text(folder + "/" + name).find("data:image/png;base64,iVBORw0KGgo"),
                std::string::npos);  // PNG's magic number
    }
  }
};

TEST_F(NdfTool, AnImage) {
  DiskImage image = rasterise(128, test::GgxNdf{0.2, 0.5});
  for (float& value : image.values) value *= 3;
  save_disk_image(folder_ / "in.exr", image, "D");
  ASSERT_EQ(run("in.exr -o out_dir"), 0) << err();
  expect_files("out_dir", false);
  const json j = result("out_dir");
  EXPECT_NEAR(j["projected_area_before"].get<double>(), 3, 0.01);
  EXPECT_NEAR(j["projected_area_after"].get<double>(), 1, 1e-6);
  EXPECT_NEAR(j["alpha_ggx_x"].get<double>(), 0.2, 0.02);
  EXPECT_NEAR(j["alpha_ggx_y"].get<double>(), 0.5, 0.02);
  EXPECT_LT(j["g1_fast_against_direct"].get<double>(), 1e-3);
  EXPECT_NEAR(projected_area(load_ndf_image(folder_ / "out_dir/ndf.exr")), 1, 1e-6);
}

TEST_F(NdfTool, TablesOfEachFormat) {
  test::write_file(folder_ / "a.mbsdf", test::make_mbsdf(1, 6, 8, std::vector<float>(3 * 6 * 6 * 8, 0.3f)));
  ASSERT_EQ(run("a.mbsdf -o a --size 64"), 0) << err();
  expect_files("a", true);
  EXPECT_FALSE(result("a").contains("file_ndf"));
  EXPECT_EQ(result("a")["kind"], "mbsdf");

  test::write_file(folder_ / "b.bsdf", test::make_rgl().bytes());
  ASSERT_EQ(run("b.bsdf -o b --size 64"), 0) << err();
  expect_files("b", true);
  const json file = result("b")["file_ndf"];
  // ndf = 1 everywhere: its integral with the cosine is pi.
  EXPECT_NEAR(file["projected_area_as_stored"].get<double>(), test::pi, 1e-3);
  EXPECT_GT(file["total_variation"].get<double>(), 0.01);
}

// What was put in comes out: width, peak and G1 of the closed form, for narrow and wide lobes, with and
// without F0, and from the part that was measured.
TEST_F(NdfTool, SynthesisedGgx) {
  struct Case {
    double alpha;
    const char *model, *file, *options;
  };
  for (const Case& c :
       {Case{0.02, "ggx:alpha=0.02,F0=0.02", "a.binary", ""}, Case{0.3, "ggx:alpha=0.3,F0=1", "a.binary", ""},
        Case{0.3, "ggx:alpha=0.3,F0=1", "a.mbsdf", ""}, Case{0.3, "ggx:alpha=0.3,F0=0.5", "a.binary", "--noise 0.05"},
        Case{1, "ggx:alpha=1,F0=0.5", "a.binary", "--noise 0.05"}, Case{1, "ggx:alpha=1,F0=1", "a.binary", ""},
        Case{1, "ggx:alpha=1,F0=0.02", "a.mbsdf", ""}, Case{0.3, "ggx:alpha=0.3,F0=1", "a.binary", "--measured-to 30"},
        Case{1, "ggx:alpha=1,F0=0.04", "a.mbsdf", "--measured-to 50"}}) {
    SCOPED_TRACE(std::string(c.model) + " " + c.file + " " + c.options);
    const std::string file = c.file;
    ASSERT_EQ(ToolFixture::run(std::string("synth ") + c.model + " -o " + file + " " + c.options), 0) << err();
    ASSERT_EQ(run(file + " -o a --size 32"), 0) << err();
    const json j = result("a"), radial = j["radial"];
    EXPECT_NEAR(radial["alpha_ggx"].get<double>() / c.alpha, 1, 0.01);
    EXPECT_NEAR(radial["alpha_ggx_of_peak"].get<double>() / c.alpha, 1, 0.01);
    for (const int t : {10, 30, 50, 70, 80, 85}) {
      const double expected = test::GgxNdf{c.alpha, c.alpha}.g1(test::at(t * test::pi / 180, 0));
      EXPECT_NEAR(radial["g1"][std::to_string(t)].get<double>(), expected, 3e-3) << t;
    }
    if (c.alpha >= 0.3 && std::string(c.options).find("--measured-to") == std::string::npos) {
      EXPECT_EQ(j["extraction"]["masking"], "height-correlated");
    }
  }
  EXPECT_NEAR(result("a")["extraction"]["measured_to_degrees"].get<double>(), 50, 1);
  EXPECT_NE(text("a/ndf.md").find("| masking and shadowing | "), std::string::npos);
}

// Measured: its D is normalised, its own sigma is that of its own ndf by our integral, and the
// distribution extracted from its retro-reflection resembles its own.
TEST_F(NdfTool, MeasuredRgl) {
  if (test::test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  for (const char* name : {"cg_sunflower_rgb", "satin_rosaline_rgb", "paper_white_rgb", "cc_iris_purple_gem_rgb"}) {
    const std::string path = (test::test_data() / "rgl" / (std::string(name) + ".bsdf")).string();
    ASSERT_EQ(run("'" + path + "' --size 64 -o " + name), 0) << err();
    const json j = result(name), file = j["file_ndf"];
    EXPECT_NEAR(j["projected_area_after"].get<double>(), 1, 1e-6);
    EXPECT_NEAR(file["projected_area_as_stored"].get<double>(), 1, 0.01);
    EXPECT_LT(file["sigma_of_its_ndf_against_its_sigma"].get<double>(), 5e-4);
    EXPECT_LT(file["total_variation"].get<double>(), 0.13);
  }
}

TEST_F(NdfTool, RefusesWithOneLine) {
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 1) << arguments;
    const std::string error = err();
    EXPECT_NE(error.find(part), std::string::npos) << error;
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_FALSE(fs::exists(folder_ / "none"));
  };
  save_disk_image(folder_ / "dark.exr", DiskImage(32), "D");
  refused("dark.exr -o none", "dark.exr: normal distribution: found 0 everywhere");
  save_disk_image(folder_ / "g1.exr", DiskImage(32), "G1");
  refused("g1.exr -o none", "gonio:quantity");
  test::write_file(folder_ / "black.mbsdf", test::make_mbsdf(1, 6, 8, std::vector<float>(3 * 6 * 6 * 8, 0.0f)));
  refused("black.mbsdf -o none", "retro-reflection");
  refused("missing -o none", "missing: no such file");
  test::write_file(folder_ / "text", "text");
  refused("text -o none", "text");
  refused("black.mbsdf -o none --size 5000", "--size");
}

}  // namespace
}  // namespace gonio
