#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/support/files.h"

namespace gonio::test {

/// Runs a command of the shell in a folder. Its exit status, or -1 if it crashed.
inline int run_in(const std::filesystem::path& folder, const std::string& command) {
  const int status = std::system(("cd '" + folder.string() + "' && " + command).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Runs the program GONIO_TOOL as a user does, in a folder of its own.
class ToolFixture : public ::testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::string text(const std::string& name) const { return file_bytes(path(name)); }

  /// The exit status; out() and err() are what was printed.
  int run(const std::string& arguments) const {
    return run_in(folder_.path(), "'" GONIO_TOOL "' " + arguments + " >.out 2>.err");
  }
  std::string out() const { return text(".out"); }
  std::string err() const { return text(".err"); }

  /// What was printed on stdout.
  std::string expect_ok(const std::string& arguments) const {
    EXPECT_EQ(run(arguments), 0) << arguments << "\n" << err();
    return out();
  }
  void expect_error(const std::string& arguments, const std::string& part) const {
    EXPECT_EQ(run(arguments), 1) << arguments;
    EXPECT_NE(err().find(part), std::string::npos) << part << "\nin " << err();
  }

  TemporaryFolder folder_;
};

}  // namespace gonio::test
