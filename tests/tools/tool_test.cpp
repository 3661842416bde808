// Runs the program GONIO_TOOL as a user does.

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/wait.h>

#include <gonio/brdf/build/stack/bsdf_options.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/table/albedo.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/stack/rounded16.h>

#include "tests/support/table_files.h"
#include "tests/support/tool_fixture.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;

/// A grey Lambertian of albedo 0.5 with 6 x 6 x 8 RGB cells.
std::string sample_mbsdf() {
  return test::make_mbsdf(1, 6, 8, std::vector<float>(3 * 6 * 6 * 8, 0.5f / pi<float>),
                          "name=\"sample\"\nMBSDF_DATA_REFLECTION=\n");
}

/// Every stored value is 100.
std::string sample_merl() {
  std::string bytes, value;
  for (const std::int32_t n : {90, 90, 180}) test::append(bytes, n);
  test::append(value, 100.0);
  for (int i = 0; i < 3 * 90 * 90 * 180; ++i) bytes += value;
  return bytes;
}

std::string sample_rgl() { return test::make_rgl().bytes(); }

struct Outcome {
  int code;  // exit status, or -1 if the program crashed
  std::string out;
  std::vector<std::string> errors;  // lines on stderr that are not progress
};

/// "building the stack of a.mbsdf: 30 %, 2 s"
bool is_progress(const std::string& line) {
  const std::string verb = line.substr(0, line.find(' '));
  const std::string verbs[] = {"reading", "building", "fitting", "writing", "computing", "checking"};
  return std::find(std::begin(verbs), std::end(verbs), verb) != std::end(verbs) && line.size() > 2 &&
         line.substr(line.size() - 2) == " s";
}

class ToolTest : public test::ToolFixture {
 protected:
  void write(const std::string& name, const std::string& bytes) const {
    fs::remove(path(name));
    std::ofstream(path(name), std::ios::binary) << bytes;
  }

  /// Leaves nothing in the folder, unlike run().
  Outcome execute(const std::string& arguments) const {
    const fs::path out = fs::path(folder_.path()) += ".out", err = fs::path(folder_.path()) += ".err";
    const int code = test::run_in(
        folder_.path(), "'" GONIO_TOOL "' " + arguments + " >'" + out.string() + "' 2>'" + err.string() + "'");
    Outcome run{code, read_bytes(out), {}};
    std::istringstream lines(read_bytes(err));
    for (std::string line; std::getline(lines, line);) {
      if (!is_progress(line)) run.errors.push_back(line);
    }
    fs::remove(out);
    fs::remove(err);
    return run;
  }

  void expect_ok(const std::string& arguments) const {
    const Outcome run = execute(arguments);
    EXPECT_EQ(run.code, 0) << arguments << "\n" << testing::PrintToString(run.errors);
    EXPECT_TRUE(run.errors.empty()) << arguments << "\n" << testing::PrintToString(run.errors);
  }

  /// Exit status 1, one line "gonio VERB: ..." on stderr with all of `parts`, and no new file.
  Outcome expect_error(const std::string& arguments, const std::vector<std::string>& parts) const {
    const std::vector<std::string> before = files();
    const Outcome run = execute(arguments);
    EXPECT_EQ(run.code, 1) << arguments;
    EXPECT_EQ(run.errors.size(), 1u) << arguments << "\n" << testing::PrintToString(run.errors);
    if (run.errors.size() == 1) {
      EXPECT_EQ(run.errors[0].rfind("gonio", 0), 0u) << run.errors[0];
      for (const std::string& part : parts) {
        EXPECT_NE(run.errors[0].find(part), std::string::npos) << part << "\nin " << run.errors[0];
      }
    }
    EXPECT_EQ(files(), before) << arguments;
    return run;
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) names.push_back(entry.path().string());
    std::sort(names.begin(), names.end());
    return names;
  }
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The albedo that `gonio info` printed for an angle; -1 if there is none.
glm::vec3 printed_albedo(const std::string& text, int degrees) {
  std::istringstream lines(text.substr(std::min(text.size(), text.find("albedo "))));
  std::string line;
  std::getline(lines, line);
  for (int angle = 0; std::getline(lines, line);) {
    glm::vec3 albedo;
    if (std::istringstream(line) >> angle >> albedo.r >> albedo.g >> albedo.b && angle == degrees) return albedo;
  }
  return glm::vec3(-1);
}

void expect_near(const glm::vec3& found, const glm::vec3& expected, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance) << "channel " << c;
}

// ---------------------------------------------------------------- usage

TEST_F(ToolTest, HelpHasExamples) {
  for (const std::string verb : {"info", "validate", "convert", "synth", "report", "fit"}) {
    const Outcome run = execute(verb + " --help");
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(run.errors.empty());
    EXPECT_TRUE(contains(run.out, "Examples:\n  gonio " + verb)) << run.out;
    EXPECT_TRUE(contains(execute("--help").out, "\n  " + verb + " ")) << verb;
  }
  const std::string help = execute("convert --help").out;
  const BsdfOptions defaults;
  EXPECT_TRUE(contains(help, "--incident INT=" + std::to_string(defaults.incident))) << help;
  EXPECT_TRUE(contains(help, "=" + std::to_string(defaults.budget / 1024) + "KiB")) << help;
  EXPECT_TRUE(contains(help, "[" + std::to_string(defaults.meridians) + "x" + std::to_string(defaults.parallels)))
      << help;
}

TEST_F(ToolTest, Version) {
  const Outcome run = execute("--version");
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out, "gonio " GONIO_VERSION "\n");
}

TEST_F(ToolTest, UsageErrors) {
  write("a.mbsdf", sample_mbsdf());
  expect_error("", {"gonio: ", "expected one of info, validate, convert, report, synth, fit"});
  expect_error("frobnicate", {"found 'frobnicate'", "info"});
  expect_error("info", {"gonio info: ", "FILE"});
  expect_error("info a.mbsdf b.mbsdf", {"b.mbsdf"});
  expect_error("info a.mbsdf --bogus", {"--bogus"});
  expect_error("info a.mbsdf --negative maybe", {"--negative: found 'maybe', expected one of zero, fill, reject"});
  expect_error("validate", {"FILE"});
  expect_error("convert a.mbsdf", {"gonio convert: ", "OUT"});
  expect_error("convert a.mbsdf b.exr --grid 40", {"--grid: found '40'"});
  expect_error("convert a.mbsdf b.exr --grid 40x", {"--grid: found '40x'"});
  expect_error("convert a.mbsdf b.exr --grid 1x9", {"found a size of 1 x 9"});
  expect_error("convert a.mbsdf b.exr --incident 1", {"incident: found 1, expected at least 2"});
  expect_error("convert a.mbsdf b.exr --incident many", {"--incident", "many"});
  expect_error("convert a.mbsdf b.exr --bytes -5", {"--bytes: found '-5'"});
  expect_error("convert a.mbsdf b.exr --bytes 5stones", {"--bytes: found '5stones'"});
  expect_error("convert a.mbsdf b.exr --bytes 99999999999999999999", {"--bytes"});
  expect_error("convert a.mbsdf b.exr --tolerance 0", {"--tolerance"});
  expect_error("convert a.mbsdf b.exr --tolerance nan", {"--tolerance"});
  expect_error("convert a.mbsdf b.mbsdf --grid 0x9", {"--grid"});
  expect_error("convert a.mbsdf b.mbsdf --grid 99999x9", {"grid: found 99999 thetas"});
}

TEST_F(ToolTest, WordsThatAreNotKnown) {
  write("a.mbsdf", sample_mbsdf());
  expect_error("convrt a.mbsdf b.exr",
               {"found 'convrt', expected one of info, validate, convert, ", "; did you mean convert?"});
  expect_error("ligth info", {"; did you mean light?"});
  expect_error("light valdate a.ies",
               {"found 'valdate', expected one of info, validate, convert, plot", "; did you mean validate?"});
  expect_error("light", {"found no verb, expected one of info, validate, convert, plot"});
  expect_error("--verson", {"found '--verson', expected one of --help, --version; did you mean --version?"});
  expect_error("convert a.mbsdf b.exr --max-varience 1e-3",
               {"gonio convert: found '--max-varience', expected one of ", "; did you mean --max-variance?"});
  expect_error("convert a.mbsdf b.exr --max-varience=1e-3",
               {"found '--max-varience'", "; did you mean --max-variance?"});
  expect_error("info --jsn", {"found '--jsn', expected one of --help, --json, --negative, ", "; did you mean --json?"});
  expect_error("light plot a.ies b.svg --plane 0", {"; did you mean --planes?"});
  expect_error("convert a.mbsdf b.exr --chart outgoin",
               {"--chart: found 'outgoin', expected one of outgoing, half, auto; did you mean outgoing?"});
  expect_error("convert a.mbsdf b.mbsfd",
               {"extension: found .mbsfd, expected one of .exr, .binary, .mbsdf, .bsdf; did you mean .mbsdf?"});
  expect_error("info a.mbsdf --negative fil", {"expected one of zero, fill, reject; did you mean fill?"});
  expect_error("render --material a.mbsdf --sampling cosin",
               {"--sampling: found 'cosin', expected one of default, cosine, ", "; did you mean cosine?"});
  expect_error("compare --material a.mbsdf --methods default,lobe3 -o c",
               {"--methods: found 'lobe3', expected one of default, ", "; did you mean lobes3?"});
  expect_error("fit a.mbsdf --model gxg+lambert",
               {"unknown lobe 'gxg'; expected one of lambert, ", "; did you mean ggx?"});
  expect_error("synth ggx:alhpa=0.1 -o b.binary",
               {"'alhpa'; expected one of alpha, F0, F90, eta, k; did you mean alpha?"});
  expect_error("light plot a.ies b.svg --normalise flx",
               {"--normalise: found 'flx', expected one of none, flux, maximum; did you mean flux?"});
  // Nothing is guessed for a word that resembles none.
  EXPECT_FALSE(contains(expect_error("frobnicate", {"expected one of"}).errors[0], "did you mean"));
}

TEST_F(ToolTest, HelpIsAVerbToo) {
  EXPECT_EQ(execute("help").out, execute("--help").out);
  EXPECT_EQ(execute("help").code, 0);
  for (const std::string verb : {"convert", "render", "light", "light plot", "help"}) {
    const Outcome run = execute("help " + verb);
    EXPECT_EQ(run.code, 0) << verb;
    EXPECT_EQ(run.out, execute(verb + " --help").out) << verb;
    EXPECT_TRUE(contains(run.out, "Usage: gonio " + verb + " ")) << run.out;
  }
  expect_error("help convrt", {"gonio help: found 'convrt', expected one of info, ", "; did you mean convert?"});
  expect_error("help light plto", {"found 'plto', expected one of info, ", "; did you mean plot?"});
  expect_error("help convert fast", {"found 'fast', expected no verb of gonio convert"});
}

TEST_F(ToolTest, OptionsWithoutEffectAreRefused) {
  write("a.mbsdf", sample_mbsdf());
  expect_ok("convert a.mbsdf a.exr");
  expect_error("convert a.mbsdf b.binary --grid 9x9", {"--grid"});
  expect_error("convert a.mbsdf b.binary --incident 9", {"--incident"});
  expect_error("convert a.mbsdf b.mbsdf --tolerance 0.1", {"--tolerance"});
  expect_error("convert a.mbsdf b.mbsdf --bytes 1MiB", {"--bytes"});
  expect_error("convert a.mbsdf b.mbsdf --budget 1MiB", {"--budget"});
  expect_error("convert a.mbsdf b.exr --max-variance 0.1 --incident 9", {"--max-variance", "by hand"});
  expect_error("convert a.mbsdf b.mbsdf --negative fill", {"--negative", "as they are stored"});
  expect_error("convert a.mbsdf b.mbsdf --phi-d 180", {"--phi-d"});
  expect_error("convert a.mbsdf b.binary --phi-d 90", {"--phi-d", "90"});
  expect_error("convert a.exr b.exr --incident 9", {"--incident"});
  expect_error("convert a.exr b.exr --missing fill", {"--missing"});
  expect_error("convert a.mbsdf b.mbsdf --comment text", {"--comment", "only a stack file has comments"});
  expect_error("convert a.mbsdf b --max-variance 0.1 --comment text", {"--comment", "only a stack file has comments"});
}

// ---------------------------------------------------------------- outputs

TEST_F(ToolTest, OutputsThatCannotBeWritten) {
  write("a.mbsdf", sample_mbsdf());
  fs::create_directory(path("folder.exr"));
  fs::create_directory(path("read_only"));
  fs::permissions(path("read_only"), fs::perms::owner_read | fs::perms::owner_exec);
  // Permissions do not hold root back; /proc does.
  const std::string read_only = geteuid() == 0 ? "/proc/" : "read_only/";
  expect_error("convert a.mbsdf b.png", {"b.png: extension: found .png, expected one of .exr, .binary, .mbsdf, .bsdf"});
  expect_error("convert a.mbsdf b", {"b: extension: found none"});
  expect_error("convert a.mbsdf missing/b.exr", {"convert: missing: no such folder"});
  expect_error("convert a.mbsdf missing/b.binary", {"convert: missing: no such folder"});
  expect_error("convert a.mbsdf a.mbsdf/b.exr", {"convert: a.mbsdf: no such folder"});
  expect_error("convert a.mbsdf b.exr --front missing/f.json", {"convert: missing: no such folder"});
  expect_ok("convert a.mbsdf folder.exr --incident 3 --grid 5x6");  // into the folder
  EXPECT_TRUE(fs::is_regular_file(path("folder.exr/a.exr")));
  for (const std::string name : {"b.exr", "b.binary", "b.mbsdf"}) {
    expect_error("convert a.mbsdf " + read_only + name, {read_only + name});
  }
  expect_error("synth default -o missing/b.binary", {"synth: missing: no such folder"});
  expect_error("synth default -o " + read_only + "b.mbsdf", {read_only + "b.mbsdf"});
  expect_error("synth default -o b.exr", {"b.exr: extension: found .exr, expected one of .binary, .mbsdf"});
  fs::permissions(path("read_only"), fs::perms::owner_all);
}

TEST_F(ToolTest, InputsThatDoNotExist) {
  write("a.mbsdf", sample_mbsdf());
  for (const std::string arguments :
       {"info none", "convert none b.exr", "convert none b.bsdf", "convert none b.binary", "report none -o r",
        "report --merge none -o r", "report a.mbsdf --stability none -o r", "fit none", "fit none --table t.md",
        "ndf none -o n", "render --material none", "render none", "compare none -o c", "compare --material none -o c",
        "light info none", "light convert none b.ldt", "light sample none", "convert --scene none --budget 1MiB -o s"})
    expect_error(arguments, {": none: no such file"});
  expect_error("synth none.json -o b.binary", {": none.json: no such file"});
  EXPECT_EQ(expect_error("validate none", {"unusable: none"}).out, "none: error: no such file\n");
  EXPECT_EQ(expect_error("light validate none", {}).out, "none: rejected\n  none: no such file\n");
  expect_error("info .", {".: found a folder, expected a file"});
  expect_error("info a.mbsdf/b", {"a.mbsdf/b: no such file"});
  write(
      "scene.json",
      R"({"environment": {"file": "sky.exr"}, "materials": {"m": {"albedo": 1}}, "objects": [{"file": "m.ply", "material": "m"}]})");
  expect_error("render scene.json", {": sky.exr: no such file"});
  write("scene.json", R"({"materials": {"m": {"albedo": 1}}, "objects": [{"file": "m.ply", "material": "m"}]})");
  expect_error("render scene.json", {": m.ply: no such file"});
}

TEST_F(ToolTest, AnInputIsNeverReplaced) {
  write("a.mbsdf", sample_mbsdf());
  fs::create_symlink("a.mbsdf", path("soft.mbsdf"));
  fs::create_hard_link(path("a.mbsdf"), path("hard.mbsdf"));
  fs::create_symlink("a.mbsdf", path("soft.exr"));
  for (const std::string out : {"a.mbsdf", "./a.mbsdf", "soft.mbsdf", "hard.mbsdf", "soft.exr"})
    expect_error("convert a.mbsdf " + out, {out + ": output: found the same file as a.mbsdf"});
  fs::create_hard_link(path("a.mbsdf"), path("b.json"));
  expect_error("convert a.mbsdf c.exr --front b.json", {"b.json: output: found the same file as a.mbsdf"});
  expect_error("convert a.mbsdf c.exr --front c.exr", {"c.exr: output: found the same file as c.exr"});
  expect_error("synth a.mbsdf -o hard.mbsdf", {"hard.mbsdf: output"});
  expect_error("fit a.mbsdf -o b.json", {"b.json: output"});
  fs::create_directory(path("folder"));
  fs::create_hard_link(path("a.mbsdf"), path("folder/report.json"));
  fs::create_hard_link(path("a.mbsdf"), path("folder/ndf.exr"));
  expect_error("report a.mbsdf -o folder", {"folder/report.json: output"});
  expect_error("report --merge folder/report.json -o folder", {"folder/report.json: output"});
  expect_error("ndf a.mbsdf -o folder", {"folder/ndf.exr: output"});
  EXPECT_EQ(read_bytes(path("a.mbsdf")), sample_mbsdf());
}

TEST_F(ToolTest, OutputsAreNamed) {
  write("a.mbsdf", sample_mbsdf());
  for (const std::string name : {"b.mbsdf", "b.exr", "b.bsdf", "b.binary"})
    EXPECT_TRUE(contains(execute("convert a.mbsdf " + name).out, "written: " + name + "\n")) << name;
  EXPECT_TRUE(contains(execute("convert b.exr c.exr").out, "written: c.exr\n"));
  EXPECT_TRUE(contains(execute("synth default -o d.binary").out, "written: d.binary\n"));
  const std::string out = execute("convert a.mbsdf paper --max-variance 0.1 --front front.json").out;
  const std::string paper = fs::exists(path("paper.json")) ? "paper.json" : "paper.exr";
  EXPECT_TRUE(fs::exists(path(paper)));
  EXPECT_TRUE(contains(out, "written: " + paper + "\nwritten: front.json\n")) << out;
  EXPECT_TRUE(contains(out, " bytes: relvar at most ")) << out;
}

// The table of what was reached: more bytes, less variance, and the last is the file.
TEST_F(ToolTest, AVarianceOutOfReach) {
  expect_ok("synth ggx:alpha=0.3,F0=0.5 -o fine.mbsdf");
  expect_ok("convert fine.mbsdf a.mbsdf --grid 12x16");
  const std::string out = execute("convert a.mbsdf a.exr --max-variance 0.001 --budget 2KiB --chart outgoing").out;
  const std::size_t table =
      out.find("  a relvar of 0.001 was not reached within 2048 bytes; what was:\n            bytes      relvar");
  ASSERT_NE(table, std::string::npos) << out;
  std::istringstream lines(out.substr(out.find("chart\n", table) + 6));
  std::size_t bytes = 0;
  double relvar = 1e9;
  std::string line, last;
  while (std::getline(lines, line) && line.rfind("written: ", 0) != 0) {
    std::size_t more = 0;
    double less = 0;
    ASSERT_TRUE(std::istringstream(line) >> more >> less) << line;
    EXPECT_GT(more, bytes);
    EXPECT_LT(less, relvar);
    bytes = more, relvar = less, last = line;
  }
  EXPECT_LE(bytes, 2048u);
  EXPECT_GT(relvar, 0.001);
  EXPECT_TRUE(contains(last, ", written")) << out;
  EXPECT_TRUE(contains(out, " incident angles, " + std::to_string(bytes) + " bytes: relvar at most ")) << out;
}

TEST_F(ToolTest, ConvertEachIntoAFolder) {
  write("a.mbsdf", sample_mbsdf());
  write("bad.mbsdf", sample_mbsdf().substr(0, 200));
  write("c.bsdf", sample_rgl());
  fs::create_directories(path("d"));
  fs::create_directories(path("out/d.x"));
  write("d/a.mbsdf", sample_mbsdf());
  expect_error("convert a.mbsdf c.bsdf d/a.mbsdf out", {"d/a.mbsdf: would become out/a.exr, as a.mbsdf does"});
  expect_error("convert a.mbsdf c.bsdf none/", {"none/: no such folder"});
  expect_error("convert a.mbsdf none/", {"none/: no such folder"});
  expect_error("convert a.mbsdf c.bsdf b.exr", {"b.exr: no such folder"});
  expect_error("convert a.mbsdf bad.mbsdf a.mbsdf", {"a.mbsdf: no such folder"});
  expect_error("convert a.mbsdf b.exr --format exr", {"--format", "the extension of OUT"});
  expect_error("convert a.mbsdf c.bsdf out --format png", {"--format", "png"});
  expect_error("convert a.mbsdf c.bsdf out --front f.json", {"--front"});

  const Outcome run = execute("convert a.mbsdf bad.mbsdf c.bsdf none.mbsdf out/ --incident 3 --grid 5x6");
  EXPECT_EQ(run.code, 1);
  ASSERT_EQ(run.errors.size(), 1u);
  EXPECT_TRUE(contains(run.errors[0], "gonio convert: 2 of 4 inputs failed: bad.mbsdf: ")) << run.errors[0];
  EXPECT_TRUE(contains(run.errors[0], "; none.mbsdf: ")) << run.errors[0];
  EXPECT_TRUE(contains(run.out, "written: out/a.exr\n")) << run.out;
  EXPECT_FALSE(contains(run.out, "bad")) << run.out;
  expect_ok("convert a.mbsdf b.exr --incident 3 --grid 5x6");
  EXPECT_EQ(load_stack(path("out/a.exr")).bsdf.diagrams.diagrams[1].density,
            load_stack(path("b.exr")).bsdf.diagrams.diagrams[1].density);
  EXPECT_EQ(load_stack(path("out/c.exr")).source, "c.bsdf");
  EXPECT_FALSE(fs::exists(path("out/bad.exr")));

  expect_ok("convert a.mbsdf c.bsdf out/d.x --format mbsdf --grid 4x8");
  EXPECT_TRUE(contains(execute("info out/d.x/c.mbsdf").out, "4 x 4 x 8 cells"));
  expect_ok("convert a.mbsdf out/d.x --format binary");  // one is enough
  EXPECT_TRUE(fs::exists(path("out/d.x/a.binary")));
}

TEST_F(ToolTest, FailureKeepsTheOldFile) {
  write("bad.mbsdf", sample_mbsdf().substr(0, 200));
  for (const std::string name : {"old.exr", "old.binary", "old.mbsdf"}) {
    write(name, "old content");
    expect_error("convert bad.mbsdf " + name, {"bad.mbsdf: reflection values"});
    EXPECT_EQ(read_bytes(path(name)), "old content");
  }
}

TEST_F(ToolTest, StandardOutputThatFails) {
  write("a.mbsdf", sample_mbsdf());
  const std::string command = "'" GONIO_TOOL "' info '" + path("a.mbsdf").string() + "' >/dev/full 2>/dev/null";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  for (const std::string verb : {"--help", "--version", "convert --help", "light info --help", "synth --list"}) {
    const std::string err = path("err").string();
    const int code = std::system(("'" GONIO_TOOL "' " + verb + " >/dev/full 2>'" + err + "'").c_str());
    EXPECT_TRUE(WIFEXITED(code) && WEXITSTATUS(code) == 1) << verb;
    EXPECT_TRUE(contains(read_bytes(err), "standard output: cannot be written\n")) << verb;
  }
}

// ---------------------------------------------------------------- info

TEST_F(ToolTest, InfoOfTables) {
  write("a.mbsdf", sample_mbsdf());
  const std::string mbsdf = execute("info a.mbsdf").out;
  EXPECT_TRUE(contains(mbsdf, "format      MBSDF\n")) << mbsdf;
  EXPECT_TRUE(contains(mbsdf, "6 x 6 x 8 cells")) << mbsdf;
  EXPECT_TRUE(contains(mbsdf, "theta_i     7.5 to 82.5")) << mbsdf;
  EXPECT_TRUE(contains(mbsdf, "file        " + std::to_string(sample_mbsdf().size()) + " bytes (3.4 KiB) on disk\n"))
      << mbsdf;
  expect_near(printed_albedo(mbsdf, 30), glm::vec3(0.5f), 1e-4f);

  write("a.bsdf", sample_rgl());
  const std::string rgl = execute("info a.bsdf").out;
  EXPECT_TRUE(contains(rgl, "format      RGL, RGB\n")) << rgl;
  EXPECT_TRUE(contains(rgl, "size        3 incident angles\n")) << rgl;
  EXPECT_TRUE(contains(rgl, "theta_i     0 to 89.95\n")) << rgl;
  EXPECT_TRUE(contains(rgl, "description uniform\n")) << rgl;

  write("a.binary", sample_merl());
  const std::string merl = execute("info a.binary").out;
  EXPECT_TRUE(contains(merl, "format      MERL\n")) << merl;
  EXPECT_TRUE(contains(merl, "size        90 x 90 x 180 cells")) << merl;
  const float albedo = 100.0f / 1500 * pi<float>;
  expect_near(printed_albedo(merl, 30), {albedo, 1.15f * albedo, 1.66f * albedo}, 1e-3f);
}

TEST_F(ToolTest, InfoCountsRepairedCells) {
  std::string bytes = sample_mbsdf();
  const float negative = -0.1f, bad = std::numeric_limits<float>::quiet_NaN();
  bytes.replace(bytes.size() - 4, 4, reinterpret_cast<const char*>(&negative), 4);
  bytes.replace(bytes.size() - 16, 4, reinterpret_cast<const char*>(&bad), 4);
  write("a.mbsdf", bytes);
  const std::string text = execute("info a.mbsdf --negative fill").out;
  EXPECT_TRUE(contains(text, "288, of which 1 negative (fill), 1 not finite (fill), 0 missing (fill)")) << text;
  expect_error("info a.mbsdf --negative reject", {"a.mbsdf: cells: found 1 negative of 288, expected none"});
  expect_error("convert a.mbsdf b.exr --nonfinite reject", {"a.mbsdf: cells: found 1 not finite"});
  expect_ok("validate a.mbsdf");  // a repair is a warning
  EXPECT_TRUE(contains(execute("validate a.mbsdf").out, "a.mbsdf: warning: cells: found 1 negative of 288"));
}

TEST_F(ToolTest, InfoOfSeveralFiles) {
  write("a.mbsdf", sample_mbsdf());
  write("bad.mbsdf", sample_mbsdf().substr(0, 200));
  write("c.bsdf", sample_rgl());
  const std::string a = execute("info a.mbsdf").out, c = execute("info c.bsdf").out;
  EXPECT_EQ(execute("info a.mbsdf c.bsdf").out, "a.mbsdf\n" + a + "\nc.bsdf\n" + c);
  const Outcome run = expect_error("info bad.mbsdf a.mbsdf none.exr c.bsdf",
                                   {"gonio info: 2 of 4 inputs failed: bad.mbsdf: ", "; none.exr: "});
  EXPECT_EQ(run.out, "a.mbsdf\n" + a + "\nc.bsdf\n" + c);
}

// One kind of value for each name, whatever is in the file.
TEST_F(ToolTest, InfoAsJson) {
  using nlohmann::json;
  std::string bytes = sample_mbsdf();
  const float negative = -0.1f;
  bytes.replace(bytes.size() - 4, 4, reinterpret_cast<const char*>(&negative), 4);
  write("a.mbsdf", bytes);
  write("c.bsdf", sample_rgl());
  expect_ok("convert c.bsdf s.exr --incident 3 --grid 5x6");

  const json table = json::parse(execute("info --json a.mbsdf --negative fill").out);
  EXPECT_EQ(table["file"], "a.mbsdf");
  EXPECT_EQ(table["kind"], "table");
  EXPECT_EQ(table["format"], "MBSDF");
  EXPECT_EQ(table["file_bytes"], bytes.size());
  EXPECT_EQ(table["cells"]["total"], 288);
  EXPECT_EQ(table["cells"]["negative"], (json{{"count", 1}, {"policy", "fill"}}));
  EXPECT_EQ(table["cells"]["missing"], (json{{"count", 0}, {"policy", "fill"}}));
  EXPECT_NEAR(table["measured_to_degrees"].get<double>(), 90, 1e-9);
  EXPECT_NEAR(table["theta_i_degrees"][0].get<double>(), 7.5, 1e-6);
  ASSERT_EQ(table["albedo"].size(), 7u);
  EXPECT_EQ(table["albedo"][2]["theta_i_degrees"], 30);
  EXPECT_NEAR(table["albedo"][2]["rgb"][1].get<double>(), 0.5, 1e-3);

  const std::string all = "info --json a.mbsdf s.exr none c.bsdf";
  const Outcome run = expect_error(all, {"1 of 4 inputs failed: none: "});
  const json several = json::parse(run.out);
  ASSERT_EQ(several.size(), 3u);
  EXPECT_EQ(several[1]["kind"], "stack");
  EXPECT_EQ(several[1]["diagrams"]["count"], 3);
  EXPECT_EQ(several[1]["colour"]["side"], 16);
  EXPECT_EQ(several[2]["file"], "c.bsdf");
  for (const json& file : several) {
    for (const char* key : {"file", "kind", "name", "format", "size", "theta_i_degrees", "file_bytes", "albedo"})
      EXPECT_TRUE(file.contains(key)) << key;
  }
  EXPECT_EQ(json::parse(expect_error("info --json none other", {"2 of 2 inputs failed"}).out), json::array());
  EXPECT_EQ(expect_error("info --json none", {"none: "}).out, "");
}

std::string all_errors(const Outcome& run) {
  std::string text;
  for (const std::string& line : run.errors) text += line + "\n";
  return text;
}

TEST_F(ToolTest, TransmissionIsNotDroppedSilently) {
  write("r.mbsdf", sample_mbsdf());
  const std::string both = sample_mbsdf() + test::make_mbsdf(0, 1, 1, {0.5f}, "MBSDF_DATA_TRANSMISSION=\n").substr(20);
  write("a.mbsdf", both);
  for (const std::string out : {"o.exr", "o.binary", "o.mbsdf", "o.bsdf"}) {
    EXPECT_TRUE(contains(all_errors(execute("convert a.mbsdf " + out)), "a.mbsdf: warning: the file has transmission"))
        << out;
    EXPECT_FALSE(contains(all_errors(execute("convert r.mbsdf " + out)), "transmission")) << out;
  }
  EXPECT_TRUE(contains(execute("info a.mbsdf").out, "the transmission of the file is left out"));
}

TEST_F(ToolTest, FilesOfOtherKindsAreNamed) {
  const std::string ldt = "A company\n1\n1\n1\n0\n19\n5\nreport\nTILT=name\n";
  const std::string ies = "IESNA:LM-63-2002\n[TEST] 1\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n";
  const auto wide = [](const std::string& text) {
    std::string bytes = "\xff\xfe";
    for (const char c : text) bytes += std::string{c, '\0'};
    return bytes;
  };
  const std::pair<std::string, std::string> kinds[] = {
      {"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 658992\n", "a Git LFS pointer"},
      {ldt, "a luminaire, EULUMDAT (gonio light info takes it)"},
      {ies, "a luminaire, IES (gonio light info takes it)"},
      {"[A] no standard\ntilt = none\n", "a luminaire, IES"},
      {wide(ies), "a luminaire, IES in UTF-16"},
      {wide("theta_i phi"), "UTF-16 text (iconv"},
      {wide("theta_i phi").substr(2), "UTF-16 text (iconv"},
      {"theta_i phi\n", "a file that starts with \"theta_i phi.\""}};
  for (const auto& [bytes, found] : kinds) {
    write("x", bytes);
    for (const std::string verb : {"info x", "convert x y.exr", "fit x -o y.json", "ndf x -o y.json"}) {
      const Outcome run = execute(verb);
      EXPECT_EQ(run.code, 1) << verb;
      EXPECT_TRUE(contains(all_errors(run), "found " + found)) << verb << ": " << all_errors(run);
    }
    const Outcome validated = execute("validate x");
    EXPECT_TRUE(contains(validated.out + all_errors(validated), "found " + found));
  }
}

// Opening a pipe would wait for ever for somebody who writes to it.
TEST_F(ToolTest, PipesAndPointersAreRefusedByEveryReader) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  write("pointer", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 658992\n");
  for (const auto& [file, found] : {std::pair("pipe", "found a pipe or a device, expected a file"),
                                    std::pair("pointer", "found a Git LFS pointer in place of the file")}) {
    const std::string name = file;
    const std::string materials =
        R"({"materials": {"a": {"albedo": 0.5}}, "camera": {"position": [0, -5, 1], "target": [0, 0, 1], "resolution": [4, 4]}, )";
    write("mesh.json", materials + R"("objects": [{"material": "a", "file": ")" + name + "\"}]}");
    write("sky.json", materials + R"("environment": {"file": ")" + name +
                          R"("}, "objects": [{"material": "a", "shape": "sphere"}]})");
    write("lamp.json",
          materials + R"("lights": [{"file": ")" + name + R"("}], "objects": [{"material": "a", "shape": "sphere"}]})");
    for (const std::string verb :
         {"info NAME", "validate NAME", "convert NAME y.exr", "convert --scene NAME -o out --budget 1MiB",
          "fit NAME -o y.json", "ndf NAME -o y.json", "report NAME -o out", "report --merge NAME -o out",
          "render NAME -o y.exr", "render mesh.json -o y.exr", "render sky.json -o y.exr", "render lamp.json -o y.exr",
          "render --material NAME -o y.exr", "compare --material NAME -o out", "light info NAME", "light validate NAME",
          "light convert NAME y.ldt"}) {
      std::string command = verb;
      if (const std::size_t at = command.find("NAME"); at != std::string::npos) command.replace(at, 4, name);
      const Outcome run = execute(command);
      EXPECT_EQ(run.code, 1) << command;
      EXPECT_TRUE(contains(all_errors(run) + run.out, found)) << command << ": " << all_errors(run) << run.out;
    }
  }
}

TEST_F(ToolTest, InfoNamesFlatRegionsAndNegativeCells) {
  // Cells of 1.5 degrees: constant in theta_in from the cell at 45.75 on, negative in a quarter.
  std::vector<float> values;
  for (int i = 0; i < 60; ++i)
    for (int o = 0; o < 60; ++o)
      for (int p = 0; p < 4; ++p)
        values.push_back(p == 0 ? -0.1f : 0.1f + 0.01f * static_cast<float>(std::min(i, 30) + o));
  write("a.mbsdf", test::make_mbsdf(0, 60, 4, values));
  const std::string text = execute("info a.mbsdf").out;
  EXPECT_TRUE(contains(text, "f_r does not change with theta_i from 46 degrees on")) << text;
  EXPECT_FALSE(contains(text, "with theta_o")) << text;
  EXPECT_TRUE(contains(text, "25 % of the cells are negative")) << text;
  write("b.mbsdf", test::make_mbsdf(0, 60, 4, std::vector<float>(values.size(), 0.3f)));
  EXPECT_FALSE(contains(execute("info b.mbsdf").out, "doubt")) << "a Lambertian is flat by nature";
}

TEST_F(ToolTest, InfoCountsRepairedDensities) {
  test::TensorBuilder file = test::make_rgl();
  const float noise = -4e-10f, nan = std::nanf("");
  std::memcpy(file["luminance"].data.data(), &noise, 4);
  std::memcpy(file["ndf"].data.data(), &nan, 4);
  write("a.bsdf", file.bytes());
  const std::string text = execute("info a.bsdf").out;
  EXPECT_TRUE(contains(text, "densities: 1 negative and 1 not finite of ")) << text;
  expect_ok("validate a.bsdf");
  const std::string warnings = execute("validate a.bsdf").out;
  EXPECT_TRUE(contains(warnings, "a.bsdf: warning: luminance: found 1 negative of ")) << warnings;
  EXPECT_TRUE(contains(warnings, "a.bsdf: warning: ndf: found 1 not finite of 8")) << warnings;
  expect_error("info a.bsdf --negative reject", {"a.bsdf: luminance: found 1 negative of "});
}

TEST_F(ToolTest, InfoOfAStack) {
  write("a.mbsdf", sample_mbsdf());
  expect_ok("convert a.mbsdf a.exr --incident 3 --grid 5x6");
  const std::string text = execute("info a.exr").out;
  for (const char* part : {"name        a\n", "source      a.mbsdf\n", "chart       outgoing\n",
                           "size        3 diagrams", "theta_i     0 to 89.5\n", "in memory   ",
                           "as they are sampled, 16 bits a crossing\n", "colour      16 x 8 cells"}) {
    EXPECT_TRUE(contains(text, part)) << part << "\nin " << text;
  }
  expect_near(printed_albedo(text, 30), glm::vec3(0.5f), 0.01f);
  const StackFile file = load_stack(path("a.exr"));
  for (const DiagramGrid& grid : file.bsdf.diagrams.diagrams) {
    EXPECT_LE(grid.phi.size(), 5u);
    EXPECT_LE(grid.r.size(), 6u);
  }
}

TEST_F(ToolTest, CommentsSayHowAStackWasMade) {
  write("a.mbsdf", sample_mbsdf());
  const std::string made =
      execute("convert a.mbsdf a.exr --max-variance 0.01 --chart half --comment 'measured by us' --comment CC0").out;
  const std::string comments = load_stack(path("a.exr")).comments;
  EXPECT_EQ(
      comments.rfind(
          "made of a.mbsdf by gonio " GONIO_VERSION " convert\n--max-variance 0.01 --chart half: relvar at most ", 0),
      0u)
      << comments;
  EXPECT_TRUE(contains(comments, " %\nmeasured by us\nCC0")) << comments;
  const std::size_t from = comments.find("relvar");  // the figures are those that convert prints
  EXPECT_TRUE(contains(made, comments.substr(from, comments.find('\n', from) - from) + "\n")) << made;
  const std::string text = execute("info a.exr").out;
  EXPECT_TRUE(contains(text, "comments    made of a.mbsdf by gonio ")) << text;
  EXPECT_TRUE(contains(text, "\n            measured by us\n            CC0\n")) << text;
  EXPECT_EQ(nlohmann::json::parse(execute("info --json a.exr").out)["comments"], comments);
  expect_ok("convert a.exr b.exr");
  EXPECT_EQ(read_bytes(path("a.exr")), read_bytes(path("b.exr")));
  expect_ok("convert a.exr c.exr --comment 'and more'");
  EXPECT_EQ(load_stack(path("c.exr")).comments, comments + "\nand more");
  expect_ok("convert a.mbsdf hand.exr --incident 3 --grid 5x6");
  EXPECT_TRUE(contains(load_stack(path("hand.exr")).comments,
                       "sizes by hand, errors not measured: at most 5 meridians, 6 parallels, 3 incident angles"));
  expect_error("convert a.exr d.exr --comment ''", {"--comment: found no text"});
  expect_error("convert a.exr d.exr --comment 'one\ntwo'", {"--comment: found control characters"});
}

// ---------------------------------------------------------------- round trips

TEST_F(ToolTest, MerlToMerlIsByteIdentical) {
  expect_ok("synth default -o a.binary --noise 0.1 --measured-to 75");
  std::string bytes = read_bytes(path("a.binary"));
  bytes.replace(12, 8, "\x01\x02\x03\x04\x05\x06\xf8\x7f", 8);  // NaN with a payload
  write("a.binary", bytes);
  expect_ok("convert a.binary b.binary");
  EXPECT_TRUE(read_bytes(path("b.binary")) == bytes);
  // Not a copy of the file: the converter knows what it writes.
  expect_ok("convert a.binary b.mbsdf --grid 9x9");
  EXPECT_EQ(read_mbsdf(path("b.mbsdf")).n_phi, 9);
}

TEST_F(ToolTest, MbsdfToMbsdfKeepsTheValues) {
  expect_ok("synth default -o a.mbsdf --noise 0.1 --measured-to 75");
  expect_ok("convert a.mbsdf b.mbsdf");
  EXPECT_TRUE(read_bytes(path("a.mbsdf")) == read_bytes(path("b.mbsdf")));
}

TEST_F(ToolTest, StackSurvivesBitByBit) {
  expect_ok("synth default -o a.mbsdf");
  expect_ok("convert a.mbsdf a.exr --bytes 20kB --tolerance 0.02");
  expect_ok("convert a.exr b.exr");
  EXPECT_EQ(read_bytes(path("a.exr")), read_bytes(path("b.exr")));
  const StackFile a = load_stack(path("a.exr")), b = load_stack(path("b.exr"));
  const auto same = [](const StackGrid& x, const StackGrid& y) {
    EXPECT_EQ(x.theta_i, y.theta_i);
    ASSERT_EQ(x.diagrams.size(), y.diagrams.size());
    for (std::size_t k = 0; k < x.diagrams.size(); ++k) {
      EXPECT_EQ(x.diagrams[k].phi, y.diagrams[k].phi);
      EXPECT_EQ(x.diagrams[k].r, y.diagrams[k].r);
      EXPECT_EQ(x.diagrams[k].density, y.diagrams[k].density);
    }
  };
  same(a.bsdf.diagrams, b.bsdf.diagrams);
  same(a.bsdf.diagrams, rounded16(a.bsdf.diagrams));
  EXPECT_EQ(a.bsdf.colour.values(), b.bsdf.colour.values());
}

TEST_F(ToolTest, StackToTableIsRefused) {
  write("a.mbsdf", sample_mbsdf());
  expect_ok("convert a.mbsdf a.exr");
  expect_error("convert a.exr b.binary", {"a.exr: format: found a stack file, expected a table"});
  expect_error("convert a.exr b.mbsdf", {"a.exr: format: found a stack file, expected a table"});
}

/// The largest error of a channel's albedo, relative to the strongest channel.
double albedo_error(const BrdfTable& expected, const BrdfTable& found, int degrees) {
  const float theta_i = static_cast<float>(degrees) * pi<float> / 180;
  const glm::vec3 a = directional_albedo(expected, theta_i), b = directional_albedo(found, theta_i);
  const glm::vec3 difference = glm::abs(b - a);
  return std::max({difference.r, difference.g, difference.b}) / std::max({a.r, a.g, a.b});
}

TEST_F(ToolTest, RglToMerlKeepsTheAlbedo) {
  const fs::path data = test::test_data();
  if (data.empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  int count = 0;
  double reciprocal = 0;
  for (const auto& entry : fs::directory_iterator(data / "rgl")) {
    if (entry.path().extension() != ".bsdf") continue;
    ++count;
    const std::string in = "'" + fs::absolute(entry.path()).string() + "'";
    expect_ok("convert " + in + " a.binary");
    expect_ok("convert " + in + " b.binary --phi-d 180");
    const BrdfTable rgl = load_table(entry.path());
    const BrdfTable merl = load_table(path("a.binary")), averaged = load_table(path("b.binary"));
    for (const int degrees : {2, 10, 30, 50, 70, 80, 85}) {
      EXPECT_LT(albedo_error(rgl, merl, degrees), 0.01) << entry.path().stem() << " at " << degrees;
      reciprocal = std::max(reciprocal, albedo_error(rgl, averaged, degrees));
    }
  }
  EXPECT_GT(count, 0);
  // These measurements are not reciprocal, so that 180 bins cannot hold them.
  EXPECT_GT(reciprocal, 0.05);
}

// ---------------------------------------------------------------- synth

TEST_F(ToolTest, SynthListsModels) {
  const Outcome run = execute("synth --list");
  EXPECT_EQ(run.code, 0);
  for (const char* part : {"ggx: ", "alpha      0.2      0.002 to 2 (slope)", "lambert: ", "default is "}) {
    EXPECT_TRUE(contains(run.out, part)) << run.out;
  }
}

TEST_F(ToolTest, SynthIsTheModel) {
  expect_ok("synth lambert:albedo=0.5/0.25/0.125 -o a.binary");
  expect_ok("synth lambert:albedo=0.5/0.25/0.125 -o a.mbsdf");
  for (const char* name : {"a.binary", "a.mbsdf"}) {
    const glm::vec3 albedo = directional_albedo(load_table(path(name)), 0.5f);
    EXPECT_NEAR(albedo.r, 0.5f, 1e-3f) << name;
    EXPECT_NEAR(albedo.g, 0.25f, 1e-3f) << name;
    EXPECT_NEAR(albedo.b, 0.125f, 1e-3f) << name;
    expect_ok(std::string("validate ") + name);
    EXPECT_EQ(execute(std::string("validate ") + name).out, std::string(name) + ": ok\n");
  }
}

TEST_F(ToolTest, SynthWritesTheModelItself) {
  expect_ok("synth ggx:alpha=0.3+lambert:albedo=0.5 -o a.json");
  expect_ok("synth a.json -o b.json");
  EXPECT_EQ(read_bytes(path("a.json")), read_bytes(path("b.json")));
  EXPECT_TRUE(contains(execute("info a.json").out, "description ggx:alpha=0.3,"));
  expect_ok("synth a.json -o a.mbsdf");
  expect_ok("synth ggx:alpha=0.3+lambert:albedo=0.5 -o b.mbsdf");
  EXPECT_TRUE(read_bytes(path("a.mbsdf")) == read_bytes(path("b.mbsdf")));
  for (const char* option : {"--noise 0.1", "--seed 2", "--measured-to 80"})
    expect_error(std::string("synth default -o c.json ") + option, {"a model has no cells"});
}

TEST_F(ToolTest, SynthNoiseIsSeeded) {
  expect_ok("synth default -o a.mbsdf --noise 0.1 --seed 3");
  expect_ok("synth default -o b.mbsdf --noise 0.1 --seed 3");
  expect_ok("synth default -o c.mbsdf --noise 0.1 --seed 4");
  EXPECT_TRUE(read_bytes(path("a.mbsdf")) == read_bytes(path("b.mbsdf")));
  EXPECT_FALSE(read_bytes(path("a.mbsdf")) == read_bytes(path("c.mbsdf")));
}

TEST_F(ToolTest, SynthLeavesHolesNearGrazing) {
  expect_ok("synth default -o a.binary --measured-to 70");
  EXPECT_GT(load_table(path("a.binary")).info().cells.missing, 0u);
  expect_ok("synth default -o b.binary");
  EXPECT_EQ(load_table(path("b.binary")).info().cells.missing, 0u);
}

TEST_F(ToolTest, SynthErrors) {
  expect_error("synth", {"gonio synth: MODEL"});
  expect_error("synth default", {"-o"});
  expect_error("synth phlogiston -o a.binary", {"unknown lobe 'phlogiston'", "ggx"});
  expect_error("synth ggx:alpha=99 -o a.binary", {"'alpha' is 99"});
  expect_error("synth default -o a.binary --noise -1", {"--noise"});
  expect_error("synth default -o a.binary --noise nan", {"--noise"});
  expect_error("synth default -o a.binary --seed x", {"--seed"});
  expect_error("synth default -o a.binary --measured-to 0", {"--measured-to"});
  expect_error("synth default -o a.binary --measured-to 91", {"--measured-to"});
}

// ---------------------------------------------------------------- damaged files

enum class Format { merl, rgl, mbsdf, stack };

struct Damage {
  const char* name;
  Format format;
  std::string (*make)(const std::string& good);
  const char* message;
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

const char* extension_of(Format format) {
  const char* extensions[] = {".binary", ".bsdf", ".mbsdf", ".exr"};
  return extensions[static_cast<int>(format)];
}

std::string replaced(std::string bytes, std::size_t at, std::uint32_t value) {
  return bytes.replace(at, 4, reinterpret_cast<const char*>(&value), 4);
}

std::string all_nan(std::string bytes, std::size_t from) {
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.end(), '\xff');
  return bytes;
}

std::string half_of(const std::string& good) { return good.substr(0, good.size() / 2); }
std::string without_last_byte(const std::string& good) { return good.substr(0, good.size() - 1); }
std::string first_ten(const std::string& good) { return good.substr(0, 10); }
std::string empty(const std::string&) { return ""; }
std::string other_magic(const std::string& good) { return replaced(good, 0, 0x12345678); }

std::string two_luminances() {
  test::TensorBuilder file = test::make_rgl();
  file["luminance"].shape[1] = 2;
  return file.bytes();
}

std::size_t mbsdf_header(const std::string& good) { return good.find("REFLECTION=\n") + 12; }

class DamageTest : public ToolTest, public testing::WithParamInterface<Damage> {
 protected:
  std::string good(Format format) const {
    if (format == Format::merl) return sample_merl();
    if (format == Format::rgl) return sample_rgl();
    if (format == Format::mbsdf) return sample_mbsdf();
    write("small.mbsdf", sample_mbsdf());
    expect_ok("convert small.mbsdf small.exr --incident 2 --grid 3x3");
    return read_bytes(path("small.exr"));
  }
};

TEST_P(DamageTest, IsNamedAndRefused) {
  const std::string original = good(GetParam().format);
  const std::string extension = extension_of(GetParam().format);
  write("good" + extension, original);
  expect_ok("validate good" + extension);
  expect_ok("info good" + extension);

  const std::string bad = "bad" + extension;
  write(bad, GetParam().make(original));
  const Outcome run = expect_error("validate " + bad, {"gonio validate: unusable: " + bad});
  EXPECT_TRUE(contains(run.out, bad + ": error: ")) << run.out;
  EXPECT_TRUE(contains(run.out, GetParam().message)) << run.out;
  expect_error("info " + bad, {"gonio info: " + bad + ": "});
  for (const char* output : {"out.exr", "out.binary", "out.mbsdf"}) {
    const bool kept = GetParam().format != Format::stack || std::string(output) == "out.exr";
    expect_error("convert " + bad + " " + output, {kept ? bad + ": " : bad});
  }
}

const Damage damages[] = {
    {"MerlHalf", Format::merl, half_of, "file size: found 17496006 bytes, expected 34992012"},
    {"MerlLastByte", Format::merl, without_last_byte, "file size: found 34992011 bytes"},
    {"MerlHeader", Format::merl, first_ten, "format: found a file that starts with"},
    {"MerlEmpty", Format::merl, empty, "format: found an empty file"},
    {"MerlMagic", Format::merl, other_magic, "dimensions: found 305419896 x 90 x 180"},
    {"MerlDimensions", Format::merl, [](const std::string& good) { return replaced(good, 8, 90); },
     "dimensions: found 90 x 90 x 90, expected 90 x 90 x 180"},
    {"MerlOtherVariant", Format::merl, [](const std::string& good) { return replaced(good, 8, 360); },
     "file size: found 34992012 bytes, expected 69984012"},
    {"MerlNan", Format::merl, [](const std::string& good) { return all_nan(good, 12); }, "no valid one"},
    {"MerlLonger", Format::merl, [](const std::string& good) { return good + "x"; }, "file size"},

    {"RglHalf", Format::rgl, half_of, "cut off"},
    {"RglLastByte", Format::rgl, without_last_byte, "cut off"},
    {"RglHeader", Format::rgl, first_ten, "found a file that starts with \"tensor_fil\""},
    {"RglEmpty", Format::rgl, empty, "format: found an empty file"},
    {"RglMagic", Format::rgl, other_magic, "format: found a file that starts with"},
    {"RglDimensions", Format::rgl, [](const std::string&) { return two_luminances(); },
     "luminance: found f32 [1, 2, 3, 2], expected f32 [1, 3, "},
    {"RglNan", Format::rgl,
     [](const std::string&) { return test::make_rgl(glm::vec3(std::numeric_limits<float>::quiet_NaN())).bytes(); },
     "no valid one"},
    {"RglAllNan", Format::rgl, [](const std::string& good) { return all_nan(good, good.find("uniform") + 7); },
     "no valid value"},

    {"MbsdfHalf", Format::mbsdf, half_of, "reflection values: found "},
    {"MbsdfLastByte", Format::mbsdf, without_last_byte, "reflection values: found 3455 bytes, expected 3456"},
    {"MbsdfHeader", Format::mbsdf, first_ten, "format: found a file that starts with \"NVIDIA ARC"},
    {"MbsdfEmpty", Format::mbsdf, empty, "format: found an empty file"},
    {"MbsdfMagic", Format::mbsdf, other_magic, "format: found a file that starts with"},
    {"MbsdfDimensions", Format::mbsdf,
     [](const std::string& good) { return replaced(good, mbsdf_header(good) + 4, 7); },
     "reflection values: found 3456 bytes, expected 4704"},
    {"MbsdfHugeDimensions", Format::mbsdf,
     [](const std::string& good) { return replaced(good, mbsdf_header(good) + 8, 0xffffffff); },
     "reflection n_phi: found 4294967295"},
    {"MbsdfType", Format::mbsdf, [](const std::string& good) { return replaced(good, mbsdf_header(good), 9); },
     "reflection type: found 9"},
    {"MbsdfNan", Format::mbsdf, [](const std::string& good) { return all_nan(good, mbsdf_header(good) + 12); },
     "no valid one"},

    {"StackHalf", Format::stack, half_of, "stack file: found "},
    {"StackLastByte", Format::stack, without_last_byte, "stack file: found "},
    {"StackHeader", Format::stack, first_ten, "stack file: found "},
    {"StackEmpty", Format::stack, empty, "format: found an empty file"},
    {"StackMagic", Format::stack, other_magic, "format: found a file that starts with"},
    {"StackDimensions", Format::stack,
     [](const std::string& good) {
       const std::string name("dataWindow\0box2i\0", 17);
       return replaced(good, good.find(name) + name.size() + 4 + 8, 63);
     },
     "stack file: found "},
    {"StackVersion", Format::stack,
     [](const std::string& good) {
       const std::string name("gonio:format\0int\0", 17);
       return replaced(good, good.find(name) + name.size() + 4, 7);
     },
     "attribute gonio:format: found 7, expected 2"},
};

INSTANTIATE_TEST_SUITE_P(Tool, DamageTest, testing::ValuesIn(damages),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_F(ToolTest, ValidateNamesAMisleadingExtension) {
  write("a.mbsdf", sample_mbsdf());
  expect_ok("convert a.mbsdf a.exr --incident 2");
  const std::string stack = read_bytes(path("a.exr"));
  const std::pair<std::string, std::string> cases[] = {
      {sample_mbsdf(), ".mbsdf"}, {sample_rgl(), ".bsdf"}, {sample_merl(), ".binary"}, {stack, ".exr"}};
  for (const auto& [bytes, right] : cases) {
    for (const std::string wrong : {".mbsdf", ".bsdf", ".binary", ".exr"}) {
      if (wrong == right) continue;
      write("b" + wrong, bytes);
      const Outcome run = expect_error("validate b" + wrong, {"unusable: b" + wrong});
      EXPECT_TRUE(contains(run.out, "b" + wrong + ": error: extension: found " + wrong + ", expected " + right))
          << run.out;
      expect_ok("info b" + wrong);  // known by its content
    }
    write("b.data", bytes);
    expect_ok("validate b.data");  // a name that promises nothing
  }
}

TEST_F(ToolTest, ValidateGoesOnAfterABadFile) {
  write("a.mbsdf", sample_mbsdf());
  write("b.mbsdf", "");
  const Outcome run = expect_error("validate missing b.mbsdf a.mbsdf .", {"unusable: missing, b.mbsdf, ."});
  EXPECT_TRUE(contains(run.out, "missing: error: ")) << run.out;
  EXPECT_TRUE(contains(run.out, "b.mbsdf: error: ")) << run.out;
  EXPECT_TRUE(contains(run.out, "a.mbsdf: ok\n")) << run.out;
  EXPECT_TRUE(contains(run.out, ".: error: ")) << run.out;
}

TEST_F(ToolTest, ValidateDoubtsAStack) {
  write("a.mbsdf", sample_mbsdf());
  expect_ok("convert a.mbsdf a.exr --incident 3");
  StackFile file = load_stack(path("a.exr"));
  file.bsdf.colour = {};
  file.bsdf.diagrams.theta_i = {0, 0.1, 0.2};
  save_stack(path("b.exr"), file);
  // Twice the scale of the second part, as another program may write it.
  std::string bytes = read_bytes(path("b.exr"));
  const std::string name("gonio:scale\0float\0\4\0\0\0", 22);
  const std::size_t at = bytes.find(name, bytes.find(name) + 1) + name.size();
  float scale;
  std::memcpy(&scale, bytes.data() + at, sizeof scale);
  scale *= 2;
  std::memcpy(bytes.data() + at, &scale, sizeof scale);
  std::ofstream(path("b.exr"), std::ios::binary) << bytes;
  const Outcome run = execute("validate b.exr");
  EXPECT_EQ(run.code, 0);
  for (const char* part : {"warning: diagram 1: found densities with integral 2,",
                           "warning: theta_i: found a last diagram at 11.46", "warning: colour: found none"}) {
    EXPECT_TRUE(contains(run.out, part)) << run.out;
  }
}

TEST_F(ToolTest, ValidateDoubtsAStackThatReflectsTooMuch) {
  write("a.mbsdf", sample_mbsdf());  // albedo 0.5
  expect_ok("convert a.mbsdf a.exr --incident 3");
  EXPECT_EQ(execute("validate a.exr").out.find("albedo"), std::string::npos);
  StackFile file = load_stack(path("a.exr"));
  std::vector<glm::vec3> values = file.bsdf.colour.values();
  const std::size_t cells = values.size() / file.bsdf.colour.theta_i().size();
  for (std::size_t k = 0; k < cells; ++k) values[k].g *= 3;  // of the first layer alone
  file.bsdf.colour = Colour(file.bsdf.colour.theta_i(), file.bsdf.colour.side(), values);
  save_stack(path("b.exr"), file);
  const Outcome run = execute("validate b.exr");
  EXPECT_EQ(run.code, 0);
  EXPECT_TRUE(contains(run.out, "b.exr: warning: albedo: found 1.5")) << run.out;
}

// ---------------------------------------------------------------- other renderers, merged reports

TEST_F(ToolTest, ConvertsToRgl) {
  write("a.mbsdf", sample_mbsdf());
  expect_ok("convert a.mbsdf a.bsdf");
  EXPECT_EQ(execute("validate a.bsdf").out, "a.bsdf: ok\n");
  const std::string info = execute("info a.bsdf").out;
  EXPECT_TRUE(contains(info, "RGL, RGB")) << info;
  for (const int degrees : {2, 50, 80}) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(printed_albedo(info, degrees)[c], 0.5f, 0.003f) << degrees;
  }
  // The same values without the spectra, and with them again.
  expect_ok("convert a.bsdf b.bsdf --rgb");
  expect_ok("convert b.bsdf c.bsdf");
  EXPECT_LT(fs::file_size(path("b.bsdf")), fs::file_size(path("a.bsdf")) / 2);
  EXPECT_EQ(read_bytes(path("c.bsdf")), read_bytes(path("a.bsdf")));
  write("small.bsdf", sample_rgl());
  expect_error("convert small.bsdf d.bsdf", {"d.bsdf: luminance and rgb: found 3 x 2"});
  expect_error("convert a.bsdf d.bsdf --negative fill", {"--negative"});
  expect_error("convert a.mbsdf d.bsdf --grid 9x9", {"--grid"});
  expect_error("convert a.mbsdf d.binary --rgb", {"--rgb", "only .bsdf"});
  expect_error("convert a.mbsdf missing/d.bsdf", {"missing: no such folder"});
}

// Their pictures lie in one folder, under the names of the materials.
TEST_F(ToolTest, ReportOfMaterialsOfOneName) {
  fs::create_directories(path("a"));
  fs::create_directories(path("b"));
  write("x.mbsdf", sample_mbsdf());
  expect_ok("convert x.mbsdf a/x.exr --incident 3 --grid 5x6");
  StackFile stack = load_stack(path("a/x.exr"));
  stack.name = "../two words";  // which is no name of a file
  save_stack(path("a/x.exr"), stack);
  fs::copy_file(path("a/x.exr"), path("b/x.exr"));
  const Outcome run = execute("report a/x.exr b/x.exr -o r");
  EXPECT_EQ(run.code, 0);
  const nlohmann::json json = nlohmann::json::parse(read_bytes(path("r/report.json")));
  EXPECT_EQ(json["materials"][0]["name"], "../two words");
  EXPECT_EQ(json["materials"][1]["name"], "../two words-2");
  const std::string text = read_bytes(path("r/report.md"));
  for (const std::string name : {".._two_words", ".._two_words-2"}) {
    EXPECT_TRUE(contains(text, "![grid](" + name + ".svg)")) << text;
    EXPECT_TRUE(fs::exists(path("r/" + name + ".svg"))) << name;
    EXPECT_TRUE(fs::exists(path("r/" + name + "-weights.svg"))) << name;
  }
}

TEST_F(ToolTest, MergesReports) {
  const auto report = [](const std::string& cpu, const std::string& material) {
    return "{\"gonio_version\": \"" GONIO_VERSION "\", \"machine\": {\"cpu\": \"" + cpu +
           "\", \"threads\": 4}, \"lights\": [], \"materials\": [{\"name\": \"" + material +
           "\", \"format\": \"merl\", \"methods\": [{\"id\": \"cosine\", \"efficiency\": 1}, "
           "{\"id\": \"displacement\", \"chart\": \"outgoing\", \"efficiency\": 2, \"mean_relvar\": 0.01, "
           "\"ns\": {\"sample\": 50}}]}]}";
  };
  fs::create_directory(path("x"));
  write("x/report.json", report("fast", "chrome"));
  write("b.json", report("slow", "gold"));
  expect_ok("report --merge x/report.json b.json x/report.json -o all");
  const std::string json = read_bytes(path("all/report.json")), text = read_bytes(path("all/report.md"));
  EXPECT_TRUE(contains(json, "fast; slow\""));
  EXPECT_TRUE(contains(json, "\"threads\": 4"));
  EXPECT_LT(json.find("chrome"), json.find("gold"));
  EXPECT_NE(json.find("chrome"), json.rfind("chrome"));
  EXPECT_TRUE(contains(text, "3 materials"));
  EXPECT_TRUE(contains(text, "| [chrome](../x/report.html) | merl | displacement | outgoing | 50 | 0.01 | 2 |"))
      << text;
  EXPECT_TRUE(contains(read_bytes(path("all/report.html")), "slow"));
  write("text.json", "no report");
  expect_error("report --merge text.json none.json -o two",
               {"2 of 2 inputs failed: text.json: is not JSON", "; none.json: no such file"});
  const Outcome partly = execute("report --merge text.json b.json -o two");
  EXPECT_EQ(partly.code, 1);
  ASSERT_EQ(partly.errors.size(), 1u);
  EXPECT_TRUE(contains(partly.errors[0], "gonio report: 1 of 2 inputs failed: text.json: is not JSON"))
      << partly.errors[0];
  EXPECT_TRUE(contains(partly.out, "written: two/report.html")) << partly.out;
  EXPECT_TRUE(contains(read_bytes(path("two/report.md")), "1 materials")) << read_bytes(path("two/report.md"));
  EXPECT_TRUE(contains(read_bytes(path("two/report.md")), "| [gold](../report.html) |"))
      << read_bytes(path("two/report.md"));
  write("list.json", "[1]");
  expect_error("report --merge list.json -o three", {"list.json: materials"});
  write("old.json", "{\"gonio_version\": \"0.0.1\", \"materials\": [], \"lights\": []}");
  expect_error("report --merge old.json -o three", {"old.json: gonio_version: found \"0.0.1\""});
}

}  // namespace
}  // namespace gonio
