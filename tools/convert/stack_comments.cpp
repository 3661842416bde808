#include "tools/convert/stack_comments.h"

#include <algorithm>
#include <cctype>

#include <gonio/mapping/base/error.h>

#include "tools/cli/number.h"

namespace gonio {

std::string describe(const CompactQuality& quality) {
  return "relvar at most " + number(quality.worst_relvar, 2) + " up to 80 degrees, evaluation error " +
         number(100 * quality.eval_error, 2) + " %, albedo within " + number(100 * quality.albedo_error, 2) + " %";
}

std::string stack_comments(const std::string& source, const std::string& made) {
  return "made of " + source + " by gonio " GONIO_VERSION " convert\n" + made;
}

void add_comment(std::string& comments, const std::string& line) {
  const bool plain = std::none_of(line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c) != 0; });
  if (line.empty() || !plain)
    throw Error(std::string("--comment: found ") + (line.empty() ? "no text" : "control characters") +
                ", expected a line of text");
  comments += (comments.empty() ? "" : "\n") + line;
}

}  // namespace gonio
