#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <gonio/fitting/model/model.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

std::string message_of(const std::string& description) {
  try {
    parse_model(description);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

void expect_message(const std::string& description, const std::string& part) {
  EXPECT_NE(message_of(description).find(part), std::string::npos) << description << " -> " << message_of(description);
}

TEST(ParseModel, ParametersFindTheirLobe) {
  const LobeModel m = parse_model("ggx+lambert:alpha=0.2,F0=0.05,albedo=0.5/0.3/0.1");
  ASSERT_EQ(m.lobes.size(), 2u);
  EXPECT_EQ(m.lobes[0].kind, LobeKind::ggx);
  EXPECT_EQ(m.lobes[0].shape[0], glm::dvec3(0.2));
  EXPECT_EQ(m.lobes[0].color[0], glm::dvec3(0.05));
  EXPECT_EQ(m.lobes[0].color[1], glm::dvec3(1));
  EXPECT_EQ(m.lobes[1].color[0], glm::dvec3(0.5, 0.3, 0.1));
  EXPECT_EQ(m.specular_count(), 1);
}

TEST(ParseModel, TheLobeBeforeTheColonComesFirst) {
  const LobeModel m = parse_model("ggx:alpha=0.3+GGX:Alpha=5e-2,f0=1e+0");
  EXPECT_EQ(m.lobes[0].shape[0].r, 0.3);
  EXPECT_EQ(m.lobes[1].shape[0].r, 0.05);
  EXPECT_EQ(m.lobes[1].color[0].r, 1.0);
}

TEST(ParseModel, EtaMakesAConductor) {
  const LobeModel m = parse_model("ggx:alpha=0.1,eta=0.2/0.9/1.1,k=3.9/2.5/2.4");
  EXPECT_EQ(m.lobes[0].fresnel, Fresnel::conductor);
  EXPECT_EQ(m.lobes[0].color[1], glm::dvec3(3.9, 2.5, 2.4));
}

TEST(ParseModel, EveryLobeAndTheDefaultMaterial) {
  for (LobeKind kind : lobe_kinds()) {
    EXPECT_EQ(parse_model(lobe_info(kind).id).lobes.at(0).kind, kind);
  }
  const LobeModel paint = parse_model("default");
  EXPECT_EQ(paint.specular_count(), 2);
  EXPECT_EQ(paint.name, "default");
}

TEST(ParseModel, SaysWhatIsWrong) {
  expect_message("", "unknown lobe ''");
  expect_message("phong", "expected one of lambert, oren_nayar");
  expect_message("ggx:alpha", "expected name=value");
  expect_message("ggx:alpha=x", "'x' of 'alpha' is not a number");
  expect_message("ggx:alpha=nan", "expected 0.002 to 2");
  expect_message("ggx:alpha=5", "alpha' is 5; expected 0.002 to 2");
  expect_message("ggx:alpha=0.1/0.2", "has 2 values");
  expect_message("ggx:roughness=0.1", "has a parameter 'roughness'");
  expect_message("ggx+ggx+lambert:alpha=0.1", "2 lobes of");
  expect_message("ggx:F0=0.1,eta=2", "both");
}

TEST(Describe, ReadsBackToTheSameBits) {
  for (const char* text : {"default", "oren_nayar:sigma=0.1/0.2/0.3+student_t:gamma=3,eta=0.3333333333333333,k=2"}) {
    const LobeModel a = parse_model(text), b = parse_model(describe(a));
    EXPECT_EQ(describe(a), describe(b));
    const glm::dvec3 wi(0.6, 0, 0.8), wo(-0.48, 0.36, 0.8);
    EXPECT_EQ(a.eval(wi, wo), b.eval(wi, wo));
  }
}

TEST(LobeModel, SumsItsLobes) {
  const glm::dvec3 wi(0.6, 0, 0.8), wo(-0.48, 0.36, 0.8);
  const LobeModel lambert = parse_model("lambert:albedo=0.5/0.3/0.1");
  EXPECT_NEAR(lambert.eval(wi, wo).g, 0.3 / pi<double>, 1e-12);
  const LobeModel ggx = parse_model("ggx:alpha=0.2,F0=0.04");
  const LobeModel both = parse_model("ggx+lambert:alpha=0.2,F0=0.04,albedo=0.5/0.3/0.1");
  const glm::dvec3 sum = lambert.eval(wi, wo) + ggx.eval(wi, wo);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(both.eval(wi, wo)[c], sum[c], 1e-12);
  EXPECT_EQ(both.eval(wi, glm::dvec3(0, 0.6, -0.8)), glm::dvec3(0));
  EXPECT_EQ(both.eval(glm::dvec3(1, 0, 0), wo), glm::dvec3(0));
  const glm::vec3 single = both.eval(glm::vec3(wi), glm::vec3(wo));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(single[c], sum[c], 1e-5);
}

TEST(ModelJson, ReadsBackToTheSameModel) {
  for (const char* text : {"default", "burley+ggx:alpha=0.1/0.2/0.3,eta=0.2,k=3+lafortune"}) {
    const LobeModel a = parse_model(text);
    const LobeModel b = model_from_json(to_json(a), "test");
    EXPECT_EQ(describe(a), describe(b));
    EXPECT_EQ(a.name, b.name);
  }
}

TEST(ModelJson, SaysWhatIsWrong) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      model_from_json(text, "fit.json");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = to_json(parse_model("ggx:alpha=0.25"));
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  EXPECT_EQ(message(changed("0.25", "0.25")), "accepted");
  const auto expect = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(message(text).find(part), std::string::npos) << message(text);
    EXPECT_EQ(message(text).find("fit.json: "), 0u) << message(text);
  };
  expect("{", "is not JSON");
  expect("{}", "no member 'format'");
  expect("[]", "no member 'format'");
  expect(changed("gonio model", "something"), "expected \"gonio model\"");
  expect(changed("\"version\": 1", "\"version\": 99"), "version is 99; expected 1");
  expect(changed("\"version\": 1", "\"version\": \"1\""), "version is \"1\"; expected 1");
  expect(changed("\"lobes\"", "\"no_lobes\""), "no member 'lobes'");
  expect(changed("\"lobe\": \"ggx\"", "\"lobe\": \"gxx\""), "lobes[0].lobe is 'gxx'");
  expect(changed("\"alpha\": {\n          \"value\": 0.25", "\"alpha\": {\n          \"value\": -1"),
         "alpha.value is -1");
  expect(changed("\"alpha\": {\n          \"value\": 0.25", "\"alpha\": {\n          \"value\": \"a\""),
         "expected a number");
}

TEST(ModelDescription, EachParameterOnce) {
  EXPECT_NO_THROW(parse_model("ggx:alpha=0.1,F0=0.2+ggx:alpha=0.3,F0=0.4"));
  for (const char* text : {"ggx:alpha=0.1,alpha=0.2", "ggx:F0=0.1,f0=0.1", "lambert:albedo=0.2,albedo=0.4",
                           "lambert:albedo=0.1,alpha=0.1+ggx:alpha=0.1", "ggx:eta=0.2,k=3,k=3"}) {
    try {
      parse_model(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(" twice; expected it once"), std::string::npos) << error.what();
    }
  }
}

TEST(LoadModel, FileOrError) {
  EXPECT_THROW(load_model("/nonexistent/fit.json"), Error);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "gonio_model_test.json";
  std::ofstream(path) << to_json(parse_model("default"));
  EXPECT_EQ(describe(load_model(path)), describe(parse_model("default")));
  std::filesystem::remove(path);
}

TEST(Snippets, ExistWhereTheModelDoes) {
  const LobeModel paint = parse_model("ggx+lambert:alpha=0.2,F0=0.1,albedo=0.3");
  const std::string pbrt = pbrt_snippet(paint), mitsuba = mitsuba_snippet(paint);
  EXPECT_NE(pbrt.find("\"float roughness\" 0.2 \"bool remaproughness\" false"), std::string::npos) << pbrt;
  // 0.1 and 0.3 add up to 0.4: both blended reflectances are 0.4, at weights 1/4 and 3/4.
  EXPECT_NE(pbrt.find("\"diffuse\" \"rgb reflectance\" [0.4 0.4 0.4]"), std::string::npos) << pbrt;
  EXPECT_NE(pbrt.find("\"float amount\" 0.75"), std::string::npos) << pbrt;
  EXPECT_NE(mitsuba.find("<float name=\"alpha\" value=\"0.2\"/>"), std::string::npos) << mitsuba;
  EXPECT_NE(mitsuba.find("<float name=\"weight\" value=\"0.75\"/>"), std::string::npos) << mitsuba;
  EXPECT_NE(pbrt_snippet(parse_model("ggx:eta=0.2,k=3")).find("\"rgb eta\" [0.2 0.2 0.2]"), std::string::npos);
  // A plain rgb above 1 is refused by Mitsuba.
  EXPECT_NE(mitsuba_snippet(parse_model("ggx:eta=0.2,k=3"))
                .find("<spectrum name=\"k\" type=\"srgb\"><rgb name=\"color\" value=\"3, 3, 3\"/>"
                      "<boolean name=\"unbounded\" value=\"true\"/></spectrum>"),
            std::string::npos);

  EXPECT_EQ(pbrt_snippet(parse_model("ward+lambert")), "");
  EXPECT_EQ(pbrt_snippet(parse_model("beckmann")), "");
  EXPECT_NE(mitsuba_snippet(parse_model("beckmann")), "");
  EXPECT_EQ(mitsuba_snippet(parse_model("student_t+lambert")), "");
  EXPECT_EQ(mitsuba_snippet(parse_model("ggx:alpha=0.1/0.2/0.3")), "");
}

}  // namespace
}  // namespace gonio
