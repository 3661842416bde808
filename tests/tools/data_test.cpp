// The files of data/, by the program GONIO_TOOL as a user meets them.

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/mapping/base/bytes.h>

#include "tests/support/tool_fixture.h"

namespace gonio {
namespace {

namespace fs = std::filesystem;

const fs::path data = GONIO_DATA;

/// The columns after the file name of a table of README.md, by file name.
std::map<std::string, std::vector<std::string>> described() {
  std::map<std::string, std::vector<std::string>> rows;
  std::istringstream lines(read_bytes(data / "README.md"));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    std::istringstream cells(line.substr(1));
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, '|');) row.push_back(cell.substr(1, cell.size() - 2));
    rows[row[0].substr(1, row[0].size() - 2)] = {row.begin() + 1, row.end()};
  }
  return rows;
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

using DataTest = test::ToolFixture;

TEST_F(DataTest, IsWhatTheReadmeSaysAndSmall) {
  const auto rows = described();
  std::uintmax_t total = 0;
  std::size_t files = 0;
  for (const fs::path& file : files_in(data)) {
    total += fs::file_size(file);
    const std::string name = fs::relative(file, data).generic_string();
    if (name == "README.md" || name == "make.sh") continue;
    ++files;
    ASSERT_EQ(rows.count(name), 1u) << name;
    EXPECT_EQ(rows.at(name)[1], std::to_string(fs::file_size(file))) << name;
  }
  EXPECT_EQ(files, rows.size());
  EXPECT_LT(total, 3000000u);
}

TEST_F(DataTest, MaterialsAreSelfContainedAndSayWhoseTheyAre) {
  const auto rows = described();
  const std::vector<fs::path> files = files_in(data / "materials");
  EXPECT_EQ(files.size(), 12u);
  for (const fs::path& file : files) {
    const StackFile stack = load_stack(file);
    EXPECT_FALSE(stack.bsdf.colour.empty()) << file;
    const std::vector<std::string>& row = rows.at("materials/" + file.filename().string());
    const std::string source = "`" + stack.source + "`";
    EXPECT_EQ(row[0].compare(0, source.size(), source), 0) << row[0];
    for (const std::string& part :
         {"made of " + stack.source, "relvar at most " + row[2] + " ", "evaluation error " + row[3] + ",",
          "albedo within " + row[4], std::string("derived from a measurement"), std::string("CC0")})
      EXPECT_NE(stack.comments.find(part), std::string::npos) << part << "\nin " << stack.comments;
    EXPECT_EQ(run("validate '" + file.string() + "'"), 0) << out();
  }
}

TEST_F(DataTest, TheDefaultIsThatOfSynth) {
  ASSERT_EQ(run("synth default -o default.json"), 0) << err();
  EXPECT_EQ(text("default.json"), read_bytes(data / "default.json"));
  EXPECT_EQ(run("validate default.json"), 0) << out();
}

TEST_F(DataTest, LampsAreAsTheStandardsHaveThem) {
  for (const fs::path& file : files_in(data / "lights")) {
    EXPECT_EQ(run("light validate '" + file.string() + "'"), 0) << out();
    EXPECT_NE(out().find(", 0 deviations"), std::string::npos) << out();
    ASSERT_EQ(run("light info '" + file.string() + "'"), 0) << err();
    EXPECT_EQ(out().find("hint"), std::string::npos) << out();
  }
}

TEST_F(DataTest, Normals) { EXPECT_EQ(run("ndf '" + (data / "normals.exr").string() + "' -o ndf"), 0) << err(); }

TEST_F(DataTest, Renders) {
  EXPECT_EQ(run("render --size 16x16 --samples 1"), 0) << err();
  EXPECT_TRUE(fs::exists(folder_ / "render.exr"));
  EXPECT_EQ(run("render '" + (data / "scene.json").string() + "' --size 16x12 --samples 1 -o scene.png"), 0) << err();
}

// A program that was copied somewhere has none.
TEST_F(DataTest, ThatIsNotThere) {
  fs::create_directory(folder_ / "bin");
  fs::copy_file(GONIO_TOOL, folder_ / "bin/gonio");
  EXPECT_EQ(test::run_in(folder_.path(), "bin/gonio render >.out 2>.err"), 1);
  for (const char* part :
       {"gonio render: SCENE: found none, ", "/data", "/share/gonio/data", "expected SCENE.json or --material FILE"})
    EXPECT_NE(err().find(part), std::string::npos) << err();
  EXPECT_FALSE(fs::exists(folder_ / "render.exr"));
}

}  // namespace
}  // namespace gonio
