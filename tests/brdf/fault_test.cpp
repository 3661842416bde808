#include <functional>

#include <fenv.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/brdf/resample/table_resample.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/stack/rounded16.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using test::TemporaryFolder;

template <class S>
float use_with_traps(const S& stack) {
  proof::Random random(4);
  feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(FE_INVALID | FE_DIVBYZERO);
  float sum = 0;
  for (const float theta_i : {0.0f, 0.2f, 0.45f, 0.7f, 1.5f, 1.5707963f})
    for (int k = 0; k < 2000; ++k) {
      constexpr float edge[] = {0, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-24f};
      const glm::vec2 u = k < 36 ? glm::vec2(edge[k % 6], edge[k / 6]) : random.pair();
      const auto s = stack.sample(theta_i, u.x, u.y);
      sum += s.pdf + stack.pdf(theta_i, s.wo);
      const auto back = stack.invert(theta_i, s.wo);
      sum += back ? back->at.u : 0;
    }
  fedisableexcept(FE_ALL_EXCEPT);
  return sum;
}

// Sampling the whole Gallery raises neither "invalid" nor "divide by zero": no NaN is made and thrown
// away on the quiet. A trap is a signal, so this is where the program would end.
TEST(Fault, NoFloatingPointExceptionWhileSampling) {
  for (const auto& entry : proof::gallery_stacks()) {
    for (const auto method : {Interpolation::nearest, Interpolation::mixture, Interpolation::displacement})
      EXPECT_GT(use_with_traps(Stack<float>(entry.grid, method)), 0) << entry.name;
    if (entry.grid.diagrams.front().azimuth == Azimuth::full || !proof::shared_lines(entry.grid)) continue;
    EXPECT_GT(use_with_traps(Stack<float>(rounded16(entry.grid), Interpolation::blend)), 0) << entry.name;
  }
}

StackFile small_stack() {
  StackFile file;
  file.name = "fault";
  file.bsdf.interpolation = Interpolation::displacement;
  for (const auto& entry : proof::gallery_stacks())
    if (entry.name == "specular") file.bsdf.diagrams = Stack<float>(entry.grid, Interpolation::displacement).grid();
  return file;
}

struct Writer {
  const char* name;
  std::function<void(const std::filesystem::path&)> write;
};

std::vector<Writer> writers() {
  static const BrdfTable table = proof::to_table(proof::gallery_tables().front());
  return {{"stack.exr", [](const auto& path) { save_stack(path, small_stack()); }},
          {"table.mbsdf", [](const auto& path) { write_table_as_mbsdf(table, path, 16, 16); }},
          {"table.binary", [](const auto& path) { write_table_as_merl(table, path, 180); }}};
}

/// Runs a function in a process of its own. @return its exit status; 100 if it ended by a signal.
int in_child(const std::function<int()>& function) {
  const pid_t child = fork();
  if (child == 0) _exit(function());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
}

int writing_fails(const Writer& writer, const std::filesystem::path& target) {
  try {
    writer.write(target);
  } catch (const Error& e) {
    return std::string(e.what()).find(writer.name) == std::string::npos ? 2 : 0;
  } catch (...) {
    return 3;
  }
  return 1;
}

// A disk that fills up: files may not grow beyond 2 KiB.
TEST(Fault, FullDisk) {
  for (const Writer& writer : writers()) {
    const TemporaryFolder folder;
    test::write_file(folder / writer.name, "old");
    EXPECT_EQ(in_child([&] {
                signal(SIGXFSZ, SIG_IGN);  // writing then fails instead
                const rlimit limit{2048, 2048};
                setrlimit(RLIMIT_FSIZE, &limit);
                return writing_fails(writer, folder / writer.name);
              }),
              0)
        << writer.name;
    EXPECT_EQ(test::file_bytes(folder / writer.name), "old") << writer.name;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << writer.name;
  }
}

TEST(Fault, ReadOnlyFolder) {
  for (const Writer& writer : writers()) {
    const TemporaryFolder folder;
    chmod(folder.path().c_str(), 0555);
    EXPECT_EQ(in_child([&] {
                if (geteuid() == 0 && (setegid(65534) != 0 || seteuid(65534) != 0))
                  return 4;  // root may write anywhere
                return writing_fails(writer, folder / writer.name);
              }),
              0)
        << writer.name;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << writer.name;
    chmod(folder.path().c_str(), 0755);
  }
}

}  // namespace
}  // namespace gonio
