#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/problem.h>

namespace gonio {

std::string to_string(const Problem& problem) {
  const std::string line = problem.line > 0 ? "line " + std::to_string(problem.line) + ": " : "";
  return line + problem.field + ": found " + problem.found + ", expected " + problem.expected;
}

void throw_if_fatal(const std::string& file, const Problems& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (problem.fatal) text += (text.empty() ? "" : "; ") + to_string(problem);
  }
  if (!text.empty()) throw Error(file + ": " + text);
}

}  // namespace gonio
