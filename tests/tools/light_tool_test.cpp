// Runs the verb light of the program GONIO_TOOL as a user does.

#include <fstream>

#include <gtest/gtest.h>

#include <gonio/mapping/light/exr/light_exr.h>

#include "tests/support/light_cases.h"
#include "tests/support/tool_fixture.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;

class LightTool : public test::ToolFixture {
 protected:
  LightTool() { test::write_file(path("in.ldt"), testing::eulumdat_text(testing::asymmetric())); }

  /// The program fails, prints one line on stderr that holds `text`, and leaves no file `output`.
  void refused(const std::string& arguments, const std::string& text, const std::string& output = "none") const {
    EXPECT_EQ(run(arguments), 1) << arguments;
    const std::string error = err();
    EXPECT_NE(error.find(text), std::string::npos) << error;
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_FALSE(fs::exists(folder_ / output));
  }
};

TEST_F(LightTool, ConvertKeepsTheLight) {
  const LightDiagram expected = testing::asymmetric().diagram;
  for (const std::string name : {"a.ies", "a.ldt", "a.exr"}) {
    ASSERT_EQ(run("light convert in.ldt " + name), 0) << err();
    Problems deviations;
    const Luminaire light = load_any_light(folder_ / name, {}, deviations);
    EXPECT_LT(testing::largest_difference(expected, light.diagram), 2e-6) << name;
  }
  ASSERT_EQ(run("light convert a.exr b.pbrt --resolution 64 --filter bspline"), 0) << err();
  EXPECT_NE(text("b.pbrt").find("\"b.pbrt.exr\""), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "b.pbrt.exr"));
  ASSERT_EQ(run("light convert in.ldt ll.exr --layout latlong --resolution 32"), 0) << err();
  ASSERT_EQ(run("light convert in.ldt one.ies --normalise flux --target 1000"), 0) << err();
  EXPECT_NEAR(flux(load_light(folder_ / "one.ies").diagram), 1000, 0.01);
}

TEST_F(LightTool, ShowsAndMeasures) {
  ASSERT_EQ(run("light info in.ldt"), 0) << err();
  EXPECT_NE(out().find("1000.00 cd at C 30, gamma 40 degrees"), std::string::npos) << out();
  ASSERT_EQ(run("light validate in.ldt"), 0) << err();
  EXPECT_NE(out().find("0 deviations"), std::string::npos) << out();
  ASSERT_EQ(run("light plot in.ldt p.svg --planes 30 --klm"), 0) << err();
  EXPECT_NE(text("p.svg").find("C30 right, C210 left"), std::string::npos);
  for (const std::string name : {"s.obj", "s.ply"}) {
    ASSERT_EQ(run("light solid in.ldt " + name + " --rows 20 --filter two-plane"), 0) << err();
    EXPECT_GT(fs::file_size(folder_ / name), 1000u);
  }
  ASSERT_EQ(run("light sample in.ldt --draws 5"), 0) << err();
  const std::string csv = out();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  ASSERT_EQ(run("light compare in.ldt --rows 30"), 0) << err();
  EXPECT_NE(out().find("Every second angle left out"), std::string::npos);
  ASSERT_EQ(run("report in.ldt -o folder"), 0) << err();
  EXPECT_NE(text("folder/report.md").find("goniometric mapping, corrected"), std::string::npos);
  const std::string json = text("folder/report.json");
  for (const char* key : {"\"lights\"", "\"uniform\"", "\"texels\"", "\"r_linear\"", "\"gamma_linear\""})
    EXPECT_NE(json.find(key), std::string::npos) << key;
}

// Radiometric files are not given in lumens.
TEST_F(LightTool, UnitsAreThoseOfTheFile) {
  Luminaire lamp = testing::lambertian();
  lamp.unit = "mW/sr";
  std::ofstream(folder_ / "uv.ies", std::ios::binary) << testing::ies_text(lamp);
  ASSERT_EQ(run("light info uv.ies"), 0) << err();
  EXPECT_NE(out().find("318.31 mW/sr at"), std::string::npos) << out();
  EXPECT_NE(out().find("flux             999.97 mW,"), std::string::npos) << out();
  EXPECT_EQ(out().find(" cd "), std::string::npos) << out();
  ASSERT_EQ(run("light plot uv.ies uv.svg"), 0) << err();
  EXPECT_NE(text("uv.svg").find("mW/sr, flux 999.97 mW<"), std::string::npos);
}

TEST_F(LightTool, ValidateTellsInTheUnitOfTheFile) {
  std::ofstream(folder_ / "uv.ies") << "IESNA:LM-63-2002\n[_INTENSITYUNITS] mW/sr\n[_TOTALLUMINAIRELUMENS] "
                                       "0.001\nTILT=NONE\n1 -1 1 3 3 1 2 0 0 0\n1 1 10\n0 45 90\n"
                                       "0 90 180\n2e-4 1e-4 0\n1e-4 1e-4 0\n2e-4 1e-4 0\n";
  ASSERT_EQ(run("light validate uv.ies"), 0) << err();
  EXPECT_NE(out().find("0.0001 to 0.0002 mW/sr"), std::string::npos) << out();
  EXPECT_NE(out().find(" mW by quadrature, expected 0.001 as"), std::string::npos) << out();
  EXPECT_EQ(out().find(" cd"), std::string::npos) << out();
}

// Everything that info says is in the luminaire's frame, with digits for what is small, and zones
// that hold no light hold 0.
TEST_F(LightTool, InfoSaysWhatTheFileHolds) {
  const auto file = [&](const std::string& angles, const std::string& values) {
    std::ofstream(folder_ / "a.ies") << "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 1 2 0 0 0\n1 1 10\n0 45 90\n"
                                     << angles << "\n"
                                     << values;
    EXPECT_EQ(run("light info a.ies"), 0) << err();
    return out();
  };
  std::string out = file("0 90 180", "100 200 0\n100 90 0\n100 10 0\n");
  EXPECT_NE(out.find("symmetry: C90-C270\n"), std::string::npos) << out;
  EXPECT_NE(out.find("200.00 cd at C 90, gamma 45"), std::string::npos) << out;
  EXPECT_EQ(out.find("hint"), std::string::npos) << out;
  EXPECT_EQ(out.find("e-1"), std::string::npos) << out;  // 6.7e-16 beyond the horizon
  EXPECT_NE(out.find(" 0 0 0 0 0 0 0 0 0 lm, every"), std::string::npos) << out;
  out = file("90 180 270", "1e-3 2e-3 0\n1e-3 9e-4 0\n1e-3 1e-4 0\n");
  EXPECT_NE(out.find("symmetry: C0-C180\n"), std::string::npos) << out;
  EXPECT_NE(out.find("0.002 cd at C 180"), std::string::npos) << out;
  EXPECT_NE(out.find("hint             the light is mirrored at the 90-270 plane"), std::string::npos) << out;
  EXPECT_NE(out.find("--ies-zero 0"), std::string::npos) << out;
  EXPECT_NE(out.find("flux             0.003857 lm"), std::string::npos) << out;
}

TEST_F(LightTool, Utf16IsRead) {
  ASSERT_EQ(run("light convert in.ldt a.ies"), 0) << err();
  const std::string ascii = text("a.ies");
  std::string utf16 = "\xFF\xFE";
  for (char c : ascii) utf16 += {c, '\0'};
  std::ofstream(folder_ / "b.ies", std::ios::binary) << utf16;
  ASSERT_EQ(run("light validate b.ies"), 0) << err();
  EXPECT_NE(out().find("encoding: found UTF-16"), std::string::npos) << out();
  EXPECT_EQ(load_light(folder_ / "b.ies").diagram.cd, load_light(folder_ / "a.ies").diagram.cd);
  EXPECT_TRUE(is_light_file(folder_ / "b.ies"));
}

TEST_F(LightTool, OtherFilesAreNamedAsWhatTheyAre) {
  const auto file = [&](const std::string& name, const std::string& start) {
    std::ofstream(folder_ / name, std::ios::binary) << start << std::string(100, ' ');
  };
  file("a.bsdf", std::string("tensor_file\0\1\0", 14));
  file("a.mbsdf", "NVIDIA ARC MBSDF V1\n");
  file("a.binary", std::string("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12));
  file("fit.json", "{\"version\": 1}");
  file("pointer.ies", "version https://git-lfs.github.com/spec/v1\noid sha256:a\nsize 1\n");
  ASSERT_EQ(run("light convert in.ldt image.exr --layout latlong --resolution 8"), 0) << err();
  for (const std::string verb : {"info", "convert", "plot", "sample", "compare"}) {
    const std::string out = verb == "convert" ? " x.ldt" : verb == "plot" ? " x.svg" : "";
    refused("light " + verb + " a.bsdf" + out, "a.bsdf: found a measured BRDF, RGL (gonio info");
    refused("light " + verb + " a.mbsdf" + out, "a.mbsdf: found a measured BRDF, MBSDF");
    refused("light " + verb + " a.binary" + out, "a.binary: found a measured BRDF, MERL");
    refused("light " + verb + " fit.json" + out, "found a JSON file");
    refused("light " + verb + " pointer.ies" + out, "found a Git LFS pointer");
    refused("light " + verb + " image.exr" + out, "found an OpenEXR file");
  }
  EXPECT_EQ(run("light validate a.bsdf"), 1);
  EXPECT_NE(out().find("found a measured BRDF, RGL"), std::string::npos) << out();
}

TEST_F(LightTool, AnInputIsNeverReplaced) {
  const std::string before = text("in.ldt");
  for (const char* name : {"hard.ldt", "hard.svg", "hard.obj", "x.pbrt.exr"})
    fs::create_hard_link(folder_ / "in.ldt", folder_ / name);
  for (const char* arguments : {"convert in.ldt in.ldt", "convert in.ldt hard.ldt", "plot in.ldt hard.svg",
                                "solid in.ldt hard.obj", "convert in.ldt x.pbrt"})
    refused(std::string("light ") + arguments, "output: found the same file as in.ldt");
  EXPECT_EQ(text("in.ldt"), before);
  for (const char* name : {"hard.svg", "hard.obj"}) EXPECT_EQ(text(name), before) << name;
}

TEST_F(LightTool, OutputsAreNamedAndABadFileStopsNoOther) {
  ASSERT_EQ(run("light convert in.ldt b.pbrt --resolution 32"), 0) << err();
  EXPECT_EQ(out(), "written: b.pbrt\nwritten: b.pbrt.exr\n");
  ASSERT_EQ(run("light plot in.ldt p.svg"), 0) << err();
  EXPECT_EQ(out(), "written: p.svg\n");
  EXPECT_EQ(run("light info missing.ldt in.ldt"), 1);
  EXPECT_NE(err().find("1 of 2 inputs failed: missing.ldt: no such file"), std::string::npos) << err();
  EXPECT_NE(out().find("I max"), std::string::npos);
}

TEST_F(LightTool, RefusesWithOneLine) {
  std::ofstream(folder_ / "bad.ies") << "IESNA91\nTILT=NONE\nfile format error\n";
  refused("light info bad.ies", "line 3: number of lamps");
  refused("light validate bad.ies in.ldt", "found 1 of 2 files unusable");
  refused("light info missing.ldt", "missing.ldt: no such file");
  std::ofstream(folder_ / "empty.ies");
  refused("light convert empty.ies x.ldt", "empty.ies", "x.ldt");
  fs::create_directory(folder_ / "folder.ies");
  refused("light convert folder.ies x.ldt", "folder.ies", "x.ldt");
  std::ofstream(folder_ / "huge.ies") << "IESNA91\nTILT=NONE\n1 1000 1 1000000000 1000000000 1 2 0 "
                                         "0 0\n1 1 10\n0 90\n0\n1 0\n";
  refused("light convert huge.ies x.exr", "huge.ies: line 3: number of vertical angles", "x.exr");
  const std::string whole = text("in.ldt");
  std::ofstream(folder_ / "half.ldt", std::ios::binary) << whole.substr(0, whole.size() / 2);
  refused("light convert half.ldt x.pbrt", "half.ldt", "x.pbrt.exr");
  refused("light convert in.ldt x.step", ".step", "x.step");
  refused("light convert in.ldt x.ies --filter bspline", "--filter", "x.ies");
  refused("light convert bad.ies x.exr", "line 3", "x.exr");
  refused("light plot in.ldt x.svg --planes 1,2,3,4,5", "planes", "x.svg");
  refused("light", "found no verb, expected one of info, validate");
}

}  // namespace
}  // namespace gonio
