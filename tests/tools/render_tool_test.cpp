// Runs the verbs render and compare of the program GONIO_TOOL as a user does.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <gonio/fitting/model/model.h>

#include "tests/support/table_files.h"
#include "tests/support/tool_fixture.h"
#include "tools/render/image/exr_image.h"

namespace gonio {
namespace {

class RenderTool : public test::ToolFixture {
 protected:
  RenderTool() {
    test::write_file(folder_ / "grey.mbsdf",
                     test::make_mbsdf(1, 6, 8, std::vector<float>(3 * 6 * 6 * 8, 0.5f / static_cast<float>(test::pi))));
  }
  int run(const std::string& arguments, const std::string& verb = "render") const {
    // An error that is found after long work, not before it, comes as the 124 of timeout.
    return test::run_in(folder_.path(), "timeout 100 '" GONIO_TOOL "' " + verb + " " + arguments + " >.out 2>.err");
  }
};

TEST_F(RenderTool, AMaterialOnTheDefaultScene) {
  ASSERT_EQ(run("--material grey.mbsdf --size 40x30 --samples 4 -o a.exr"), 0) << err();
  ASSERT_EQ(run("--material grey.mbsdf --size 40x30 --samples 4 -o b.exr --threads 1"), 0) << err();
  EXPECT_EQ(text("a.exr"), text("b.exr"));
  const RgbImage image = load_rgb(folder_ / "a.exr");
  EXPECT_EQ(image.width, 40);
  EXPECT_EQ(image.height, 30);
  for (const glm::vec3& p : image.pixels) EXPECT_GT(p.g, 0.0f);
  for (const char* channel : {"albedo.R", "normal.X", "variance.G"})
    EXPECT_NE(text("a.exr").find(channel), std::string::npos) << channel;
  ASSERT_EQ(run("--material grey.mbsdf --size 40x30 --seconds 0.2 -o a.png --sampling cosine"), 0) << err();
  EXPECT_EQ(text("a.png").substr(1, 3), "PNG");
}

TEST_F(RenderTool, AScene) {
  test::write_file(
      folder_ / "s.json",
      R"({"camera": {"position": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "vertical_fov": 10, "resolution": [8, 8]},
    "environment": {"constant": 1}, "materials": {"m": {"file": "grey.mbsdf"}}, "objects": [{"shape": "square", "material": "m"}]})");
  ASSERT_EQ(run("s.json --samples 256 -o a.exr"), 0) << err();
  for (const glm::vec3& p : load_rgb(folder_ / "a.exr").pixels) EXPECT_NEAR(p.g, 0.5f, 0.01f);
}

// A white furnace of each kind of material file, in an environment from a file.
TEST_F(RenderTool, MaterialsAndEnvironmentFromFiles) {
  test::write_file(folder_ / "fit.json", to_json(parse_model("lambert:albedo=0.5")));
  ASSERT_EQ(run("grey.mbsdf stack.exr --incident 4", "convert"), 0) << err();
  const RgbImage sky{4, 2, std::vector<glm::vec3>(8, glm::vec3(0.5f, 1, 2))};
  save_layers(folder_ / "sky.exr", {{"", {"R", "G", "B"}, &sky}});
  for (const std::string file : {"grey.mbsdf", "stack.exr", "fit.json"}) {
    test::write_file(
        folder_ / "s.json",
        R"({"camera": {"position": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "vertical_fov": 10, "resolution": [8, 8]},
      "environment": {"file": "sky.exr", "turn": 30}, "materials": {"m": {"file": ")" +
            file + R"("}}, "objects": [{"shape": "square", "material": "m"}]})");
    ASSERT_EQ(run("s.json --samples 256 -o a.exr"), 0) << err();
    for (const glm::vec3& p : load_rgb(folder_ / "a.exr").pixels)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c] / sky.pixels[0][c], 0.5f, 0.01f) << file;
  }
}

// The comparison holds what docs/guide/render.md says, and its page needs no other file.
TEST_F(RenderTool, Compare) {
  ASSERT_EQ(
      run("--material grey.mbsdf --size 16x16 --seconds 0.05 --reference-seconds 0.2 --methods default,cosine -o c",
          "compare"),
      0)
      << err();
  const nlohmann::json j = nlohmann::json::parse(text("c/compare.json"));
  ASSERT_EQ(j["runs"].size(), 4u);
  for (const nlohmann::json& run : j["runs"]) {
    for (const char* key : {"method", "strategy", "samples", "seconds", "relmse", "standard_error", "ratio",
                            "relmse_at_equal_samples", "cost_ratio", "convergence"})
      EXPECT_TRUE(run.contains(key)) << key;
    const std::string name = run["method"].get<std::string>() + "_" + run["strategy"].get<std::string>();
    EXPECT_EQ(text("c/" + name + ".png").substr(1, 3), "PNG");
    EXPECT_EQ(text("c/" + name + "_difference.png").substr(1, 3), "PNG");
    EXPECT_NE(text("c/compare.md").find("| " + run["method"].get<std::string>() + " |"), std::string::npos);
  }
  EXPECT_NE(text("c/compare.html").find("data:image/png;base64,"), std::string::npos);
  EXPECT_EQ(text("c/compare.html").find("src=\"http"), std::string::npos);
  EXPECT_EQ(run("--material grey.mbsdf --methods rgl -o d", "compare"), 1);
  EXPECT_NE(err().find("--methods: found rgl"), std::string::npos) << err();
  EXPECT_EQ(run("--material grey.mbsdf --seconds 0 -o d", "compare"), 1);
  EXPECT_EQ(run("-o d", "compare"), 1);
  EXPECT_NE(err().find("SCENE: found none, expected SCENE.json or --material FILE"), std::string::npos) << err();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "d"));
}

// A stack file is compared with cosine sampling of its own values.
TEST_F(RenderTool, CompareAStackFile) {
  ASSERT_EQ(run("ggx:alpha=0.15,F0=0.9 -o metal.mbsdf", "synth"), 0) << err();
  ASSERT_EQ(run("metal.mbsdf metal.exr --incident 7 --grid 16x16 --interpolation blend", "convert"), 0) << err();
  ASSERT_EQ(run("--material metal.exr --size 24x24 --seconds 0.2 --reference-seconds 1 -o c", "compare"), 0) << err();
  const nlohmann::json j = nlohmann::json::parse(text("c/compare.json"));
  ASSERT_EQ(j["runs"].size(), 4u);
  EXPECT_GT(j["pixels"], 100);
  EXPECT_EQ(j["runs"][0]["method"], "default");
  EXPECT_EQ(j["runs"][1]["method"], "cosine");
  EXPECT_GT(j["runs"][3]["relmse_at_equal_samples"], 2 * j["runs"][2]["relmse_at_equal_samples"].get<double>());
  EXPECT_EQ(run("--material metal.exr --methods lobes1 -o d", "compare"), 1);
  EXPECT_NE(
      err().find("--methods: found lobes1, which not every material of the scene has, expected one of default, cosine"),
      std::string::npos)
      << err();
}

TEST_F(RenderTool, ANameThatIsNotUtf8) {
  const std::string name = "gr\xFFy";
  std::filesystem::rename(folder_ / "grey.mbsdf", folder_ / (name + ".mbsdf"));
  ASSERT_EQ(run("--material " + name + ".mbsdf --size 8x8 --seconds 0.02 --methods cosine -o c", "compare"), 0)
      << err();
  EXPECT_EQ(nlohmann::json::parse(text("c/compare.json"))["scene"], "gr\uFFFDy");
}

TEST_F(RenderTool, OutputsThatCannotBeWrittenAreFoundBeforeTheWork) {
  std::filesystem::create_directory(folder_ / "folder.exr");
  // Root may write to any real folder; /proc takes no files.
  EXPECT_EQ(run("--material grey.mbsdf --samples 16777216 -o /proc/a.exr"), 1);
  EXPECT_NE(err().find("/proc/a.exr: folder: found one that takes no files"), std::string::npos) << err();
  EXPECT_EQ(run("--material grey.mbsdf --samples 16777216 -o folder.exr"), 1);
  EXPECT_NE(err().find("folder.exr: found a folder"), std::string::npos) << err();
  EXPECT_EQ(run("--material grey.mbsdf --methods cosine --seconds 100000 -o /proc", "compare"), 1);
  EXPECT_NE(err().find("/proc/compare.html: folder: found one that takes no files"), std::string::npos) << err();
  EXPECT_EQ(run("--material grey.mbsdf --methods cosine --seconds 100000 -o grey.mbsdf", "compare"), 1);
  EXPECT_NE(err().find("grey.mbsdf: cannot be made a folder"), std::string::npos) << err();
}

TEST_F(RenderTool, AnInputIsNeverReplaced) {
  std::filesystem::create_hard_link(folder_ / "grey.mbsdf", folder_ / "grey.exr");
  EXPECT_EQ(run("--material grey.mbsdf --samples 16777216 -o grey.exr"), 1);
  EXPECT_NE(err().find("grey.exr: output: found the same file as grey.mbsdf, expected another"), std::string::npos)
      << err();
}

TEST_F(RenderTool, ErrorsAreOneLineAndLeaveNoFile) {
  test::write_file(folder_ / "s.json", R"({"materials": {}, "objects": []})");
  test::write_file(folder_ / "manifest.json", R"({"format": "gonio scene", "version": 1, "materials": []})");
  test::write_file(folder_ / "fit.json", to_json(parse_model("ggx:alpha=0.3+lambert:albedo=0.5")));
  const std::pair<const char*, const char*> cases[] = {
      {"s.json --material grey.mbsdf", "SCENE: found one and --material"},
      {"s.json", "s.json: objects: found []"},
      {"manifest.json",
       "manifest.json: found a manifest of gonio convert --scene (docs/guide/scene.md), expected a scene of gonio "
       "render "
       "(docs/guide/render.md)"},
      {"--material none.bsdf", "gonio render: none.bsdf: no such file\n"},
      {"--material grey.mbsdf --samples 0", "--samples: found 0"},
      {"--material grey.mbsdf --sampling best", "--sampling: found 'best', expected one of default, cosine"},
      {"--material grey.mbsdf --sampling rgl", "grey.mbsdf: sampling: found rgl, expected a method for a mbsdf file"},
      {"--material fit.json --sampling lobes2", "fit.json: sampling: found lobes2, expected a method for a model file"},
      {"--material grey.mbsdf --exposure nan", "--exposure: found nan"},
      {"--material grey.mbsdf --seconds inf", "--seconds: found inf"},
      {"--material grey.mbsdf --seconds 0", "--seconds: found 0, expected more than 0"},
      {"--material grey.mbsdf --seconds 1 --samples 4", "--samples: found one, expected none beside --seconds"},
      {"--material grey.mbsdf --bounces -1", "--bounces: found -1"},
      {"--material grey.mbsdf --threads -1", "--threads: found -1"},
  };
  for (const auto& [arguments, message] : cases) {
    EXPECT_EQ(run(std::string(arguments) + " -o x.exr"), 1) << arguments;
    EXPECT_NE(err().find(std::string("gonio render: ")), std::string::npos) << err();
    EXPECT_NE(err().find(message), std::string::npos) << err();
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.exr"));
  }
}

}  // namespace
}  // namespace gonio
