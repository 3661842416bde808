#include "tools/cli/check_not_input.h"

#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code none;
  if (std::filesystem::equivalent(a, b, none)) return true;
  // Files that are yet to be written.
  const auto real_a = std::filesystem::weakly_canonical(a, none), real_b = std::filesystem::weakly_canonical(b, none);
  return !real_a.empty() && real_a == real_b;
}

}  // namespace

void check_not_input(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs) {
  for (const auto& input : inputs) {
    if (same_file(output, input))
      throw Error(output.string() + ": output: found the same file as " + input.string() +
                  ", expected another: it would be replaced");
  }
}

void check_not_input(const std::filesystem::path& folder, const std::vector<std::string>& names,
                     const std::vector<std::filesystem::path>& inputs) {
  for (const std::string& name : names) check_not_input(folder / name, inputs);
}

}  // namespace gonio
