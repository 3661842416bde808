#include "tools/render/scene/read_scene.h"

#include <limits>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json good() {
  return json::parse(R"({
    "camera": {"position": [0, -5, 2], "target": [0, 0, 1], "up": [0, 0, 1], "vertical_fov": 30, "resolution": [64, 32]},
    "environment": {"constant": [1, 0.5, 0.25], "scale": 2, "turn": 90},
    "materials": {"white": {"albedo": 0.8}, "black": {"albedo": [0, 0, 0], "two_sided": false}},
    "objects": [{"shape": "sphere", "material": "white", "scale": [1, 2, 3], "rotate": [90, 0, 0], "translate": [0, 0, 4], "emission": 1},
                {"shape": "square", "material": "black"}]
  })");
}

std::string error_of(const json& scene, const std::filesystem::path& folder = {}) {
  try {
    make_scene(scene, "s.json", folder);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

json with(const char* pointer, const json& value) {
  json scene = good();
  scene[json::json_pointer(pointer)] = value;
  return scene;
}

TEST(ReadScene, ReadsEveryField) {
  const Scene scene = make_scene(good(), "s.json", {});
  EXPECT_EQ(scene.camera.width, 64);
  EXPECT_EQ(scene.camera.height, 32);
  EXPECT_NEAR(scene.camera.vertical_fov, pi<float> / 6, 1e-6f);
  EXPECT_EQ(scene.environment->radiance({0, 0, 1}), glm::vec3(2, 1, 0.5f));
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].emission, glm::vec3(1));
  EXPECT_FALSE(scene.materials[scene.objects[1].material].two_sided);
  // Scaled, then turned about x (y to z, z to -y), then moved.
  glm::vec3 low(1e9f), high(-1e9f);
  for (const glm::vec3& p : scene.objects[0].mesh->positions)
    for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(low[c], glm::vec3(-1, -3, 2)[c], 1e-3f);
    EXPECT_NEAR(high[c], glm::vec3(1, 3, 6)[c], 1e-3f);
  }
}

TEST(ReadScene, ErrorsNameFileAndField) {
  EXPECT_EQ(error_of(good()), "none");
  const std::pair<json, const char*> cases[] = {
      {with("/colour", 1),
       "s.json: colour: found an unknown member, expected one of camera, environment, materials, objects, lights"},
      {with("/camera/fov", 30),
       "s.json: camera.fov: found an unknown member, expected one of position, target, up, vertical_fov, resolution"},
      {with("/camera/position", json::array({1, 2})), "s.json: camera.position: found [1,2], expected three numbers"},
      {with("/camera/vertical_fov", 180), "s.json: camera.vertical_fov: found 180, expected a number from 0.01 to 179"},
      {with("/camera/resolution", json::array({0, 5})), "s.json: camera.resolution: found [0,5]"},
      {with("/camera/target", json::array({0, -5, 2})),
       "s.json: camera.target: found a view along up, or of no length"},
      {with("/camera", 3), "s.json: camera: found 3, expected an object"},
      {with("/environment/constant", -1), "s.json: environment.constant: found -1, expected a number from 0"},
      {with("/environment", json::object()),
       "s.json: environment.file: found none, expected one of file, sky and constant"},
      {with("/environment/suns", 2),
       "s.json: environment.suns: found an unknown member, expected one of file, sky, constant, scale, turn"},
      {with("/environment/file", "a.exr"),
       "s.json: environment.file: found another as well, expected one of file, sky and constant"},
      {with("/environment/sky", {{"sun", {0, 0, 1}}}), "s.json: environment.file: found another as well"},
      {with("/environment", {{"sky", {{"moon", 1}}}}),
       "s.json: environment.sky.moon: found an unknown member, expected one of sun, radius, radiance"},
      {with("/materials/white/colour", 1),
       "s.json: materials.white.colour: found an unknown member, expected one of file, albedo, sampling, two_sided"},
      {with("/materials/white/sampling", "cosine"), "s.json: materials.white.sampling: found one, expected none"},
      {with("/objects/0/size", 1),
       "s.json: objects[0].size: found an unknown member, expected one of shape, file, material, scale, rotate, "
       "translate, emission"},
      {with("/lights", json::array({json{{"intensity", 1}}})),
       "s.json: lights[0].intensity: found an unknown member, expected one of file, position, rotate, scale"},
      {with("/materials/white/albedo", 1.5),
       "s.json: materials.white.albedo: found 1.5, expected a number from 0 to 1"},
      {with("/materials/white/file", "a.bsdf"), "s.json: materials.white.file: found albedo as well"},
      {with("/materials/white", json::object()), "s.json: materials.white.file: found none"},
      {with("/materials/white/two_sided", 1), "s.json: materials.white.two_sided: found 1, expected true or false"},
      {with("/materials/white", json{{"file", "/nonexistent/a.bsdf"}}), "/nonexistent/a.bsdf"},
      {with("/objects/0/material", "red"), "s.json: objects[0].material: found 'red', expected one of "},
      {with("/objects/0/shape", "torus"), "s.json: objects[0].shape: found 'torus', expected one of square, sphere"},
      {with("/objects/0/scale", 0), "s.json: objects[0].scale: found 0"},
      {with("/objects/0/file", "a.obj"), "s.json: objects[0].shape: found file as well"},
      {with("/objects", json::array()), "s.json: objects: found []"},
      {with("/camera/position", json::array({0, 1e30, 0})),
       "s.json: camera.position: found [0,1e+30,0], expected three numbers from -1e+09 to 1e+09"},
      {with("/camera/up", json::array({0, 1e308, 0})), "s.json: camera.up: found"},
      {with("/environment/turn", 1e30), "s.json: environment.turn: found 1e+30, expected a number from -360 to 360"},
      {with("/environment/constant", 1e13),
       "s.json: environment.constant: found 10000000000000.0, expected a number from 0 to 1e+12"},
      {with("/environment/scale", 1e12), "none"},
      {with("/environment/constant", 1e12), "s.json: environment: found a radiance of"},
      {with("/environment", json{{"sky", {{"sun", {0, 0, 1}}, {"radiance", 1e38}}}}),
       "s.json: environment.sky.radiance: found 1e+38"},
      {with("/objects/0/emission", 1e38), "s.json: objects[0].emission: found 1e+38"},
      {with("/objects/0/rotate", json::array({0, 0, 1e6})), "s.json: objects[0].rotate: found"},
      {with("/objects/0/translate", json::array({0, 0, 1e10})), "s.json: objects[0].translate: found"},
      {with("/objects/0/scale", 1e-12), "s.json: objects[0].scale: found 1e-12, expected sizes from 1e-09"},
      {with("/objects/0", {{"shape", "square"}, {"material", "white"}, {"scale", 1e9}, {"translate", {1e9, 0, 0}}}),
       "s.json: objects[0].shape: found a placed vertex with a coordinate of 2e+09, expected -1e+09 to 1e+09"},
      {with("/lights", json::array({json{{"file", "/nonexistent/lamp.ies"}, {"position", {0, 0, 1}}}})),
       "/nonexistent/lamp.ies"},
  };
  for (const auto& [scene, message] : cases) EXPECT_THAT(error_of(scene), HasSubstr(message));
}

TEST(ReadScene, RefusesWhatIsNoJson) {
  const test::TemporaryFolder folder;
  const auto error = [&](const std::string& text) -> std::string {
    test::write_file(folder / "s.json", text);
    try {
      read_scene(folder / "s.json");
    } catch (const Error& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_EQ(error(good().dump()), "none");
  EXPECT_THAT(error("{\"camera\": "), HasSubstr("s.json: is not JSON: parse error at line 1, column 12"));
  EXPECT_THAT(error(R"({"materials": {"a": {"albedo": 0.1}, "a": {"albedo": 0.9}}, "objects": []})"),
              HasSubstr("s.json: materials.a: found twice, expected once"));
  EXPECT_THAT(error("{\"materials\": " + std::string(100000, '[')),
              HasSubstr("s.json: found objects or arrays more than 64 deep"));
}

TEST(ReadScene, MethodsHaveToSuitTheTable) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "grey.mbsdf", test::make_mbsdf(1, 4, 4, std::vector<float>(3 * 4 * 4 * 4, 0.1f)));
  const auto scene = [&](const char* sampling) {
    return with("/materials/white", json{{"file", (folder / "grey.mbsdf").string()}, {"sampling", sampling}});
  };
  EXPECT_EQ(error_of(scene("cosine")), "none");
  EXPECT_THAT(error_of(scene("best")),
              HasSubstr("s.json: materials.white.sampling: found 'best', expected one of default, cosine"));
  EXPECT_THAT(error_of(scene("rgl")),
              HasSubstr("s.json: materials.white.sampling: found rgl, expected a method for a mbsdf file"));
}

TEST(ReadScene, MeshesAndLightsAreRead) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  test::write_file(
      folder / "one.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  test::write_file(folder / "lamp.ies",
                   "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 80 0\n");
  test::write_file(folder / "empty.obj", "v 0 0 0\n");
  json scene = good();
  scene["objects"] = {{{"file", "quad.obj"}, {"material", "white"}}, {{"file", "one.ply"}, {"material", "white"}}};
  scene["lights"] = {{{"file", "lamp.ies"}, {"position", {0, 0, 3}}, {"rotate", {90, 0, 0}}, {"scale", 0.5}}};
  const Scene read = make_scene(scene, "s.json", folder.path());
  EXPECT_EQ(read.objects[0].mesh->triangles.size(), 2u);
  EXPECT_EQ(read.objects[1].mesh->triangles.size(), 1u);
  ASSERT_EQ(read.lights.size(), 1u);
  // Turned about x, the nadir (-z) points along +y.
  EXPECT_NEAR((read.lights[0].to_light * glm::vec3(0, 1, 0)).z, -1, 1e-6f);
  test::write_file(folder / "nan.obj", "v nan 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  test::write_file(folder / "huge.obj", "v 1e30 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  test::write_file(folder / "tiny.obj", "v 0 0 0\nv 1e-12 0 0\nv 0 1e-12 0\nf 1 2 3\n");
  const std::pair<const char*, const char*> bad[] = {
      {"empty.obj", "empty.obj"},
      {"nan.obj", "s.json: objects[0].file: found a placed vertex with a coordinate of nan, expected -1e+09 to 1e+09"},
      {"huge.obj", "s.json: objects[0].file: found a placed vertex with a coordinate of 1e+30"},
      {"tiny.obj", "s.json: objects: found a scene of radius 7.07107e-13, expected at least 1e-09"},
  };
  for (const auto& [file, message] : bad) {
    scene["objects"] = {{{"file", file}, {"material", "white"}}};
    EXPECT_THAT(error_of(scene, folder.path()), HasSubstr(message));
  }
}

TEST(ReadScene, AnEnvironmentFromAFile) {
  const test::TemporaryFolder folder;
  RgbImage image{8, 4, {}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 8; ++column)
      image.pixels.push_back(row < 2 ? glm::vec3(1, 2, 3) : glm::vec3(column < 4 ? 4 : 8));
  save_layers(folder / "sky.exr", {{"", {"R", "G", "B"}, &image}});
  const json environment{{"file", "sky.exr"}, {"scale", {1, 0.5, 2}}};
  const Scene read = make_scene(with("/environment", environment), "s.json", folder.path());
  EXPECT_EQ(read.environment->radiance({0, 0, 1}), glm::vec3(1, 1, 6));
  // Left of the middle column, which looks along +x, is +y.
  const glm::vec3 left = glm::normalize(glm::vec3(0, 1, -1));
  EXPECT_EQ(read.environment->radiance(left).r, 4);
  json turned = with("/environment", environment);
  turned["environment"]["turn"] = 180;
  EXPECT_EQ(make_scene(turned, "s.json", folder.path()).environment->radiance(left).r, 8);
  image.pixels[5].g = std::numeric_limits<float>::infinity();
  save_layers(folder / "sky.exr", {{"", {"R", "G", "B"}, &image}});
  EXPECT_THAT(error_of(turned, folder.path()), HasSubstr("sky.exr: found a radiance of inf, expected 0 to 1e12"));
}

TEST(ReadScene, AMaterialOfFittedLobes) {
  const test::TemporaryFolder folder;
  const LobeModel model = parse_model("ggx:alpha=0.3,F0=0.5+lambert:albedo=0.2");
  test::write_file(folder / "fit.json", to_json(model));
  json scene = with("/materials/white", {{"file", "fit.json"}});
  const Scene read = make_scene(scene, "s.json", folder.path());
  const Material& white = read.materials[read.objects[0].material];
  EXPECT_EQ(white.sampling, SamplingMethod::lobes1);
  ASSERT_TRUE(white.table && white.model);
  const glm::vec3 wi = glm::normalize(glm::vec3(1, 0, 2)), wo = glm::normalize(glm::vec3(-1, 0.3f, 1));
  EXPECT_NEAR(white.table->eval(wi, wo).g / model.eval(wi, wo).g, 1, 0.01);
  EXPECT_EQ(MethodBuilder(white.table, white.model).build(white.sampling)->eval(wi, wo), white.table->eval(wi, wo));
  scene["materials"]["white"]["sampling"] = "lobes2";
  EXPECT_THAT(error_of(scene, folder.path()),
              HasSubstr("s.json: materials.white.sampling: found lobes2, expected a method for a model file"));
}

}  // namespace
}  // namespace gonio
