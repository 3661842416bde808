// `gonio convert --scene`, run as a user does.

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/build/budget/incidence_profile.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/bytes.h>

#include "tests/support/table_files.h"
#include "tests/support/tool_fixture.h"

namespace gonio {
namespace {

using nlohmann::json;

class SceneToolTest : public test::ToolFixture {
 protected:
  void write_table(const std::string& name, const std::string& model) const {
    write_mbsdf(path(name), synthesize_mbsdf(parse_model(model), 30, 36));
  }

  void write_scene(const json& materials) const {
    test::write_file(path("scene.json"),
                     json{{"format", "gonio scene"}, {"version", 1}, {"materials", materials}}.dump());
  }

  int run(const std::string& arguments) const { return ToolFixture::run("convert " + arguments); }
  std::string expect_ok(const std::string& arguments) const { return ToolFixture::expect_ok("convert " + arguments); }
  void expect_error(const std::string& arguments, const std::string& part) const {
    ToolFixture::expect_error("convert " + arguments, part);
    EXPECT_FALSE(std::filesystem::exists(path("stacks"))) << arguments;
  }

  json summary(const std::string& folder = "stacks") const {
    return json::parse(read_bytes(path(folder + "/scene-budget.json")));
  }
};

TEST_F(SceneToolTest, NamesWhatIsWrongInAManifest) {
  write_table("a.mbsdf", "lambert:albedo=0.5");
  const auto expect = [&](const std::string& text, const std::string& part) {
    test::write_file(path("scene.json"), text);
    expect_error("--scene scene.json --budget 1MiB -o stacks", "scene.json: " + part);
  };
  const auto manifest = [](const std::string& materials) {
    return R"({"format": "gonio scene", "version": 1, "materials": )" + materials + "}";
  };
  const auto material = [&](const std::string& members) {
    return manifest(R"([{"name": "one", "file": "a.mbsdf", "share": 1}, {)" + members + "}]");
  };
  expect("{\"format\": \"gonio sc", "is not JSON: parse error at line 1");
  expect("", "is not JSON");
  expect("[]", "the file: found array, expected an object");
  expect("{}", "the file: found none, expected a member 'format'");
  expect(R"({"format": "gonio model", "version": 1, "materials": []})",
         R"(format: found "gonio model", expected "gonio scene")");
  expect(R"({"format": "gonio scene", "version": 2, "materials": []})", "version: found 2, expected 1");
  expect(R"({"format": "gonio scene", "version": 1, "material": []})",
         "the file: found an unknown member 'material', expected one of format, version, materials; did you mean "
         "materials?");
  expect(R"({"materials": {}, "objects": []})",
         "found a scene of gonio render (docs/guide/render.md), expected a manifest of gonio convert --scene "
         "(docs/guide/scene.md)");
  expect(manifest("[]"), "materials: found array, expected an array of at least one");
  expect(manifest("[7]"), "materials[0]: found number, expected an object");
  expect(material(R"("name": "b", "file": "a.mbsdf")"), "materials[1]: found none, expected a member 'share'");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": "half")"), "materials[1].share: found \"half\"");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": -1)"),
         "materials[1].share: found -1, expected a finite number >= 0");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": null)"), "materials[1].share: found null");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": 1, "shares": 1)"),
         "materials[1]: found an unknown member 'shares', expected one of name, file, share, incidence; did you mean "
         "share?");
  expect(material(R"("name": "", "file": "a.mbsdf", "share": 1)"), "materials[1].name: found \"\"");
  expect(material(R"("name": "one", "file": "a.mbsdf", "share": 1)"), "materials[1].name: found 'one' again");
  expect(material(R"("name": "../b", "file": "a.mbsdf", "share": 1)"), "materials[1].name: found '../b'");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": 1, "incidence": 3)"), "materials[1].incidence: found 3");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": 1, "incidence": [])"),
         "materials[1].incidence: found []");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": 1, "incidence": [0, 0])"),
         "materials[1].incidence: found a sum of 0");
  expect(material(R"("name": "b", "file": "a.mbsdf", "share": 1, "incidence": [1, -2])"),
         "materials[1].incidence[1]: found -2");
  expect(manifest(R"([{"name": "one", "file": "a.mbsdf", "share": 0}])"), "materials: share: found a sum of 0");
}

TEST_F(SceneToolTest, RefusesWhatASceneDoesNotTake) {
  write_table("a.mbsdf", "lambert:albedo=0.5");
  write_scene({{{"name", "a"}, {"file", "a.mbsdf"}, {"share", 1}}});
  expect_error("--scene scene.json -o stacks", "--budget");
  expect_error("--scene scene.json --budget 1MiB", "--output");
  expect_error("--scene scene.json --budget much -o stacks", "--budget: found 'much'");
  expect_error("--scene scene.json --budget 1MiB -o stacks --chart half", "--chart: found one, expected none");
  expect_error("a.mbsdf stacks --scene scene.json --budget 1MiB -o stacks", "IN: found one, expected none");
  expect_error("a.mbsdf a.exr -o stacks", "--output: found one, expected none");
  expect_error("--scene missing.json --budget 1MiB -o stacks", "missing.json");
  expect_error("--scene scene.json --budget 1MiB -o a.mbsdf", "a.mbsdf: found a file, expected a folder");
  test::write_file(path("a.mbsdf"), "no table");
  expect_error("--scene scene.json --budget 1MiB -o stacks", "a.mbsdf");
}

// A hundred materials take minutes to build; timeout exits with 124.
TEST_F(SceneToolTest, AFolderThatTakesNoFilesIsFoundBeforeTheWork) {
  write_table("a.mbsdf", "ggx:alpha=0.1,F0=0.5+lambert:albedo=0.1");
  json materials;
  for (int k = 0; k < 100; ++k) materials.push_back({{"name", std::to_string(k)}, {"file", "a.mbsdf"}, {"share", 1}});
  write_scene(materials);
  for (const auto& [folder, part] :
       {std::pair("/proc", "/proc/scene-budget.json: folder: found one that takes no files"),
        std::pair("a.mbsdf/stacks", "a.mbsdf/stacks: cannot be made a folder: ")}) {
    EXPECT_EQ(test::run_in(folder_.path(), "timeout 60 '" GONIO_TOOL "' convert --scene scene.json --budget 9MiB -o " +
                                               std::string(folder) + " >.out 2>.err"),
              1);
    EXPECT_NE(err().find(part), std::string::npos) << err();
  }
}

TEST_F(SceneToolTest, AMaterialThatFailsCostsTheOthersNothing) {
  write_table("a.mbsdf", "lambert:albedo=0.5");
  test::write_file(path("bad.mbsdf"), "no table");
  write_scene({{{"name", "missing"}, {"file", "none.mbsdf"}, {"share", 1}},
               {{"name", "a"}, {"file", "a.mbsdf"}, {"share", 2}},
               {{"name", "bad"}, {"file", "bad.mbsdf"}, {"share", 1}}});
  EXPECT_EQ(run("--scene scene.json --budget 60kB -o stacks"), 1);
  EXPECT_NE(err().find("gonio convert: 2 of 3 inputs failed: none.mbsdf: no such file; bad.mbsdf: "), std::string::npos)
      << err();
  EXPECT_NE(out().find("written: stacks/a.exr\nwritten: stacks/scene-budget.json\n"), std::string::npos) << out();
  EXPECT_GT(load_bsdf(path("stacks/a.exr")).bytes(), 0u);
  EXPECT_FALSE(std::filesystem::exists(path("stacks/bad.exr")));
  const json result = summary();
  ASSERT_EQ(result["materials"].size(), 1u);
  EXPECT_EQ(result["materials"][0]["name"], "a");
  EXPECT_EQ(result["materials"][0]["share"], 0.5);
  EXPECT_EQ(result["bytes"], result["materials"][0]["bytes"]);
}

// A mirror on nearly all of the picture, a glossy and a matt material on the rest of it.
TEST_F(SceneToolTest, SplitsTheBytesWhereTheyCount) {
  write_table("mirror.mbsdf", "ggx:alpha=0.03,F0=0.5+lambert:albedo=0.1");
  write_table("plastic.mbsdf", "ggx:alpha=0.2,F0=0.04+lambert:albedo=0.5/0.3/0.1");
  write_table("wall.mbsdf", "lambert:albedo=0.5");
  IncidenceProfile profile;
  for (int n = 0; n < 100; ++n) profile.record(0.9f - 0.006f * static_cast<float>(n));
  write_scene({{{"name", "mirror"}, {"file", "mirror.mbsdf"}, {"share", 90}, {"incidence", profile.counts()}},
               {{"name", "plastic"}, {"file", "plastic.mbsdf"}, {"share", 5}},
               {{"name", "wall"}, {"file", "wall.mbsdf"}, {"share", 5}}});
  constexpr std::size_t budget = 60000;
  const std::string out = expect_ok("--scene scene.json --budget 60kB -o stacks");
  const json result = summary();
  std::size_t bytes = 0, even_bytes = 0;
  double variance = 0, even_variance = 0;
  ASSERT_EQ(result["materials"].size(), 3u);
  for (const json& material : result["materials"]) {
    const std::string name = material["name"];
    EXPECT_NE(out.find("\n" + name + " "), std::string::npos) << out;
    const StackFile file = load_stack(path("stacks") / material["file"].get<std::string>());
    EXPECT_EQ(BatchLayout(sampled_stack(file.bsdf)).bytes() + file.bsdf.colour.bytes(), material["bytes"]) << name;
    EXPECT_EQ(load_stack(path("stacks/" + name + ".exr")).name, name);
    EXPECT_TRUE(Bsdf(file.bsdf).self_contained()) << name;
    bytes += material["bytes"].get<std::size_t>();
    even_bytes += material["even_split"]["bytes"].get<std::size_t>();
    EXPECT_DOUBLE_EQ(material["contribution"], material["share"].get<double>() * material["relvar"].get<double>());
    variance += material["contribution"].get<double>();
    even_variance += material["share"].get<double>() * material["even_split"]["relvar"].get<double>();
    // What was chosen is a point of the curve, which falls.
    const json& curve = material["curve"];
    EXPECT_TRUE(std::any_of(curve.begin(), curve.end(), [&](const json& p) {
      return p["bytes"] == material["bytes"] && p["relvar"] == material["relvar"];
    }));
    for (std::size_t k = 1; k < curve.size(); ++k) {
      EXPECT_GT(curve[k]["bytes"], curve[k - 1]["bytes"]);
      EXPECT_LT(curve[k]["relvar"], curve[k - 1]["relvar"]);
    }
  }
  EXPECT_EQ(result["bytes"], bytes);
  EXPECT_LE(bytes, budget);
  EXPECT_EQ(result["even_split"]["bytes"], even_bytes);
  EXPECT_LE(even_bytes, budget);
  EXPECT_DOUBLE_EQ(result["summed_variance"], variance);
  EXPECT_DOUBLE_EQ(result["even_split"]["summed_variance"], even_variance);
  EXPECT_GT(even_variance, 2 * variance) << out;
  EXPECT_EQ(result["materials"][0]["incidence"], "recorded");
  EXPECT_EQ(result["materials"][1]["incidence"], "unknown");
}

}  // namespace
}  // namespace gonio
