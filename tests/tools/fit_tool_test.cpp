// Runs `gonio fit`, and the verbs that read what it writes, as a user does.

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/table/table.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"
#include "tests/support/tool_fixture.h"

namespace gonio {
namespace {

constexpr const char* one_lobe = "ggx:alpha=0.4,F0=0.2/0.15/0.1+lambert:albedo=0.3/0.2/0.1";
constexpr const char* two_lobes = "ggx:alpha=0.7,F0=0.3+ggx:alpha=0.2,F0=0.1+lambert:albedo=0.1";

class FitToolTest : public test::ToolFixture {
 protected:
  /// A table of 24 x 24 x 36 cells.
  void write_table(const std::string& name, const char* model) const {
    write_mbsdf(path(name), synthesize_mbsdf(parse_model(model), 24, 36));
  }
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(FitToolTest, WritesTheModelThatMadeTheTable) {
  write_table("a.mbsdf", one_lobe);
  const std::string out = expect_ok("fit a.mbsdf --model ggx+lambert -o fit.json");
  for (const char* part :
       {"converged after", "1.ggx.alpha", "relative L1", "to 75 deg", "beyond", "written: fit.json"}) {
    EXPECT_TRUE(contains(out, part)) << part << "\n" << out;
  }
  const LobeModel model = load_model(path("fit.json"));
  EXPECT_EQ(model.name, "a");
  ASSERT_EQ(model.lobes.size(), 2u);
  for (const Lobe& lobe : model.lobes) {
    // Reading between cells of 4 degrees costs some percent.
    if (lobe.specular()) {
      EXPECT_NEAR(lobe.shape[0].r, 0.4, 0.02);
      EXPECT_NEAR(lobe.color[0].g, 0.15, 0.015);
    } else {
      EXPECT_NEAR(lobe.color[0].b, 0.1, 0.01);
    }
  }
  const auto json = nlohmann::json::parse(read_bytes(path("fit.json")));
  EXPECT_LT(json["errors"]["inside_cutoff"]["relative_l1"].get<double>(), 0.03);
  EXPECT_TRUE(json["snippets"].contains("pbrt-v4"));
  EXPECT_TRUE(json["snippets"].contains("mitsuba3"));
}

TEST_F(FitToolTest, AutoTakesAsManyLobesAsHelp) {
  write_table("one.mbsdf", one_lobe);
  write_table("two.mbsdf", two_lobes);
  EXPECT_TRUE(contains(expect_ok("fit two.mbsdf -o two.json"), "the fewest within 10 % of the best"));
  EXPECT_GE(load_model(path("two.json")).specular_count(), 2);
  expect_ok("fit two.mbsdf --model ggx+lambert -o one.json");
  EXPECT_EQ(load_model(path("one.json")).specular_count(), 1);
}

TEST_F(FitToolTest, OptionsReachTheFit) {
  write_table("a.mbsdf", "ggx:alpha=0.2/0.4/0.6,F0=0.2+lambert:albedo=0.2");
  expect_ok("fit a.mbsdf --model ggx+lambert -o shared.json");
  expect_ok("fit a.mbsdf --model ggx+lambert --channels separate -o separate.json");
  const auto alphas = [&](const char* name) {
    for (const Lobe& lobe : load_model(path(name)).lobes)
      if (lobe.specular()) return lobe.shape[0];
    return glm::dvec3(0);
  };
  EXPECT_EQ(alphas("shared.json").r, alphas("shared.json").b);
  EXPECT_NEAR(alphas("separate.json").r, 0.2, 0.02);
  EXPECT_NEAR(alphas("separate.json").b, 0.6, 0.05);
  EXPECT_TRUE(contains(expect_ok("fit a.mbsdf --model ggx+lambert --cutoff 60"), "to 60 deg"));
  const std::string help = expect_ok("fit --help");
  EXPECT_TRUE(contains(help, "--cutoff DEGREES [75]") || contains(help, "--cutoff DEGREES=75")) << help;
}

// What the reader filled in is neither fitted nor compared, and info says what there is.
TEST_F(FitToolTest, MeasuredToThirtyDegrees) {
  for (const char* file : {"a.binary", "a.mbsdf"}) {
    const std::string name = file;
    expect_ok("synth ggx:alpha=0.3,F0=0.5+lambert:albedo=0.2 --measured-to 30 -o " + name);
    EXPECT_TRUE(contains(expect_ok("info " + name), "measured    to 30 degrees from the normal\n"));
    const std::string out = expect_ok("fit " + name + " --model ggx+lambert -o fit.json");
    EXPECT_TRUE(contains(out, "-           CIEDE2000")) << out;
    for (const Lobe& lobe : load_model(path("fit.json")).lobes) {
      if (lobe.specular()) {
        EXPECT_NEAR(lobe.shape[0].r, 0.3, 0.001);
      } else {
        EXPECT_NEAR(lobe.color[0].r, 0.2, 0.001);
      }
    }
    const auto errors = nlohmann::json::parse(read_bytes(path("fit.json")))["errors"];
    EXPECT_LT(errors["inside_cutoff"]["relative_l1"].get<double>(), 0.001);
    EXPECT_TRUE(errors["beyond_cutoff"]["relative_l1"].is_null());
    EXPECT_TRUE(contains(expect_ok("fit " + name + " --table errors.md"), "written"));
    EXPECT_TRUE(contains(read_bytes(path("errors.md")), "| - | - | - | - | - |"));
  }
}

TEST_F(FitToolTest, WritesATableOfErrors) {
  write_table("one.mbsdf", one_lobe);
  write_table("two.mbsdf", two_lobes);
  expect_ok("fit one.mbsdf two.mbsdf --table errors.md");
  std::istringstream lines(read_bytes(path("errors.md")));
  int rows = 0;
  double before = 0;
  std::string line, name;
  while (std::getline(lines, line)) {
    if (line.rfind("| one |", 0) != 0 && line.rfind("| two |", 0) != 0) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(2));
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 15u) << line;
    const double cost = std::stod(cells[12]);
    if (cells[0] == name) {
      EXPECT_LE(cost, before) << line;  // more lobes never fit worse
    }
    name = cells[0];
    before = cost;
    ++rows;
  }
  EXPECT_EQ(rows, 6);
}

// One bad input costs the others nothing, and is named at the end.
TEST_F(FitToolTest, GoodInputsSurviveABadOne) {
  write_table("a.mbsdf", one_lobe);
  std::ofstream(path("bad.mbsdf")) << read_bytes(path("a.mbsdf")).substr(0, 300);
  write_table("black.mbsdf", "lambert:albedo=0");  // loads, and cannot be fitted
  expect_error("fit a.mbsdf bad.mbsdf black.mbsdf none.mbsdf --table e.md", "3 of 4 inputs failed: bad.mbsdf: ");
  EXPECT_TRUE(contains(read_bytes(path(".err")), "; black.mbsdf: "));
  EXPECT_TRUE(contains(read_bytes(path(".err")), "none.mbsdf: "));
  EXPECT_TRUE(contains(read_bytes(path("e.md")), "| a | 1 |"));
  expect_error("report a.mbsdf bad.mbsdf -o report --grid 6x6 --incident 3", "1 of 2 inputs failed: bad.mbsdf: ");
  EXPECT_EQ(nlohmann::json::parse(read_bytes(path("report/report.json")))["materials"].size(), 1u);
  expect_error("report bad.mbsdf none.mbsdf -o none", "2 of 2 inputs failed");
  EXPECT_FALSE(std::filesystem::exists(path("none")));
}

TEST_F(FitToolTest, RefusesWhatItCannotDo) {
  write_table("a.mbsdf", one_lobe);
  expect_ok("convert a.mbsdf a.exr --incident 3");
  expect_error("fit a.mbsdf --model nosuch -o x.json", "unknown lobe 'nosuch'");
  expect_error("fit a.mbsdf --cutoff 0 -o x.json", "--cutoff: found 0");
  expect_error("fit a.mbsdf --channels many -o x.json", "--channels: found 'many', expected one of shared, separate");
  expect_error("fit a.mbsdf --starts -1 -o x.json", "starts");
  expect_error("fit a.mbsdf a.mbsdf -o x.json", "IN: found 2, expected one, or --table");
  expect_error("fit a.mbsdf -o x.json --table x.md", "-o: found one, expected none");
  expect_error("fit a.mbsdf -o x.txt", "extension: found .txt, expected one of .json");
  expect_error("fit a.exr -o x.json", "found a stack file");
  expect_error("fit missing.mbsdf -o x.json", "missing.mbsdf");
  write_table("black.mbsdf", "lambert:albedo=0");
  expect_error("fit black.mbsdf -o x.json", "black.mbsdf: ");
  EXPECT_FALSE(std::filesystem::exists(path("x.json")));
  EXPECT_FALSE(std::filesystem::exists(path("x.md")));
}

TEST_F(FitToolTest, ModelFilesAreInputs) {
  const LobeModel model = parse_model(one_lobe);
  std::ofstream(path("fit.json")) << to_json(model);
  expect_ok("synth fit.json -o s.binary");
  expect_ok("convert fit.json c.binary");
  EXPECT_TRUE(read_bytes(path("s.binary")) == read_bytes(path("c.binary")));
  expect_ok("convert fit.json c.mbsdf --grid 12x8");
  EXPECT_EQ(read_mbsdf(path("c.mbsdf")).values, synthesize_mbsdf(model, 12, 8).values);
  expect_ok("convert fit.json c.exr --incident 3");
  EXPECT_TRUE(std::filesystem::exists(path("c.exr")));
  const glm::vec3 wi(0.6f, 0, 0.8f), wo(-0.48f, 0.36f, 0.8f);
  const glm::vec3 exact = model.eval(wi, wo), read = load_table(path("c.binary")).eval(wi, wo);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(read[c], exact[c], 0.01f * exact[c]);
  const std::string info = expect_ok("info fit.json");
  for (const char* part : {"model of analytic lobes", "2 lobes, 1 of them specular", "ggx:alpha=0.4", "albedo"}) {
    EXPECT_TRUE(contains(info, part)) << part << "\n" << info;
  }
  EXPECT_TRUE(contains(expect_ok("validate fit.json"), "fit.json: ok"));
  std::ofstream(path("bright.json")) << to_json(parse_model("lambert:albedo=1.5"));
  EXPECT_TRUE(contains(expect_ok("validate bright.json"), "warning: albedo"));
  std::ofstream(path("cut.json")) << "{\"format\": \"gonio mod";
  expect_error("validate cut.json", "unusable: cut.json");
  expect_error("info cut.json", "cut.json: is not JSON");
  expect_error("convert fit.json d.binary --phi-d 360", "--phi-d");
  expect_error("convert fit.json d.binary --negative zero", "--negative");
  std::ofstream(path("broken.json")) << "{\"format\": \"gonio mod";
  expect_error("convert broken.json d.exr", "broken.json: is not JSON");
  expect_error("synth broken.json -o d.binary", "broken.json: is not JSON");
  expect_error("synth missing.json -o d.binary", "missing.json");
}

// What nests deeper than the stack is high, or says two things at once, wherever JSON is read.
TEST_F(FitToolTest, EveryVerbRefusesHostileJson) {
  std::ofstream(path("twice.json")) << R"({"format": "gonio model", "name": "a", "name": "b"})";
  std::ofstream deep(path("deep.json"));
  for (int k = 0; k < 100000; ++k) deep << "{\"a\":";
  deep.close();
  for (const auto& [file, part] : {std::pair("deep.json", "deep.json: found objects or arrays more than 64 deep"),
                                   std::pair("twice.json", "twice.json: name: found twice, expected once")}) {
    const std::string in = file;
    for (const std::string& verb :
         {"info " + in, "fit " + in + " -o out.json", "report " + in + " -o out", "synth " + in + " -o out.binary",
          "convert " + in + " out.exr", "convert --scene " + in + " --budget 1MiB -o out",
          "render " + in + " -o out.exr", "render --material " + in + " -o out.exr", "compare " + in + " -o out",
          "report --merge " + in + " -o out"})
      expect_error(verb, part);
    EXPECT_EQ(run("validate " + in), 1);
    const std::string message = part;
    EXPECT_TRUE(contains(out(), message.substr(message.find(": ") + 2))) << out();
    std::ofstream(path("fit.json")) << to_json(parse_model(one_lobe));
    expect_error("report fit.json --stability " + in + " -o out", part);
  }
}

TEST_F(FitToolTest, ReportComparesLobesAndStacks) {
  // A name that is no UTF-8 loses a letter, and no report.
  std::ofstream(path("fit\xff.json")) << to_json(parse_model(one_lobe));
  expect_ok("report fit\xff.json -o report --grid 16x16 --incident 12");
  const auto report = nlohmann::json::parse(read_bytes(path("report/report.json")));
  const auto& material = report["materials"][0];
  EXPECT_EQ(material["name"], "fit\xef\xbf\xbd");
  EXPECT_EQ(material["format"], "model");
  ASSERT_EQ(material["fits"].size(), 3u);
  for (const auto& fit : material["fits"]) {
    EXPECT_FALSE(fit["model"].get<std::string>().empty());
    EXPECT_LT(fit["errors"]["inside_cutoff"]["relative_l1"].get<double>(), 0.01);
  }
  int lobes = 0;
  for (const auto& method : material["methods"]) {
    if (method["id"].get<std::string>().rfind("lobes", 0) != 0) continue;
    ++lobes;
    EXPECT_EQ(method["params"]["adaption"], "shapes");
    for (const auto& angle : method["angles"]) {
      if (angle["theta_i_deg"].get<double>() <= 70) {
        EXPECT_LT(angle["relvar"].get<double>(), 0.05);
      }
      EXPECT_GT(angle["chi2_p"].get<double>(), 1e-6);
    }
  }
  EXPECT_EQ(lobes, 3);
  ASSERT_EQ(material["curves"].size(), 4u);
  for (const auto& method : material["methods"]) {
    const double ns = method["ns"]["sample"], relvar = method["mean_relvar"];
    EXPECT_NEAR(method["efficiency"].get<double>() * ns * (relvar + 0.001), 1, 1e-6) << method["id"];
    ASSERT_EQ(method["curves"].size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(method["curves"][k]["pdf"].size(), material["curves"][k]["theta_o_deg"].size());
      double shares = method["curves"][k]["weights"]["zero"];
      for (const double share : method["curves"][k]["weights"]["shares"]) shares += share;
      EXPECT_NEAR(shares, 1, 1e-3) << method["id"];
    }
  }
  const std::string verdict = material["verdict"];
  EXPECT_TRUE(contains(verdict, "Sample it with ")) << verdict;
  for (const char* file : {"report/report.md", "report/report.html"})
    EXPECT_TRUE(contains(read_bytes(path(file)), verdict)) << file;
  EXPECT_GT(material["lobes_against_stack"]["equal_time_ratio"].get<double>(), 0);
  EXPECT_TRUE(contains(read_bytes(path("report/report.md")), "For this material a "));
}

// A report compares fits with what was measured, and has a dash where nothing was.
TEST_F(FitToolTest, ReportOfATableMeasuredToThirtyDegrees) {
  SynthOptions options;
  options.measured_to = 30 * pi<double> / 180;
  write_mbsdf(path("a.mbsdf"), synthesize_mbsdf(parse_model(one_lobe), 24, 24, options));
  expect_ok("report a.mbsdf -o report --grid 6x6 --incident 3");
  const auto material = nlohmann::json::parse(read_bytes(path("report/report.json")))["materials"][0];
  ASSERT_EQ(material["fits"].size(), 3u);
  for (const auto& fit : material["fits"]) {
    EXPECT_LT(fit["errors"]["inside_cutoff"]["relative_l1"].get<double>(), 0.01);
    EXPECT_TRUE(fit["errors"]["beyond_cutoff"]["albedo"].is_null());
  }
  int lobes = 0;
  for (const auto& point : material["front"]) {
    if (point["id"].get<std::string>().rfind("lobes", 0) != 0) continue;
    EXPECT_LT(point["eval_error"].get<double>(), 0.01);
    ++lobes;
  }
  EXPECT_EQ(lobes, 3);
  EXPECT_TRUE(contains(read_bytes(path("report/report.md")), " | – | – | – | – | – |\n"));
}

// A mixture has no batch form, and is reported all the same.
TEST_F(FitToolTest, ReportOfAMixture) {
  write_table("a.mbsdf", one_lobe);
  expect_ok("convert a.mbsdf a.exr --incident 3 --grid 6x6");
  StackFile stack = load_stack(path("a.exr"));
  stack.bsdf.interpolation = Interpolation::mixture;
  save_stack(path("mixture.exr"), stack);
  expect_ok("report a.exr mixture.exr -o report");
  const auto report = nlohmann::json::parse(read_bytes(path("report/report.json")));
  const auto& displacement = report["materials"][0]["methods"][0];
  const auto& mixture = report["materials"][1]["methods"][0];
  EXPECT_EQ(displacement["id"], "displacement");
  EXPECT_TRUE(displacement["ns"].contains("sample_batch"));
  EXPECT_EQ(mixture["id"], "mixture");
  EXPECT_FALSE(mixture["ns"].contains("sample_batch"));
  EXPECT_GT(mixture["ns"]["sample"], 0);
}

TEST_F(FitToolTest, MergeTakesReportsAlone) {
  const auto write = [&](const char* name, const std::string& materials, const std::string& lights = "[]") {
    std::ofstream(path(name)) << "{\"gonio_version\": \"" GONIO_VERSION
                                 "\", \"machine\": 1, \"command\": 2, \"materials\": "
                              << materials << ", \"lights\": " << lights << "}";
  };
  write("number.json", "[{}, 5]");
  expect_error("report --merge number.json -o all",
               "gonio report: number.json: materials[1]: found number, expected an object");
  write("light.json", "[]", "[[]]");
  expect_error("report --merge light.json -o all", "light.json: lights[0]: found array, expected an object");
  EXPECT_FALSE(std::filesystem::exists(path("all")));
  // Members of other types than gonio writes are as good as none.
  write("odd.json", R"([{"name": 1, "methods": [3, {"efficiency": "x", "ns": 4}]}, {"methods": {"a": 1}}])");
  expect_ok("report --merge odd.json odd.json -o all");
  EXPECT_TRUE(contains(read_bytes(path("all/report.md")), "4 materials"));
}

}  // namespace
}  // namespace gonio
