#pragma once

#include <string>
#include <vector>

namespace gonio {

/// One thing that is wrong with a file.
struct Problem {
  std::string field;     ///< part of the file that is at fault
  std::string found;     ///< what it holds
  std::string expected;  ///< what it should hold
  bool fatal;    ///< true: the file cannot be used; false: it loads, with a repair, a doubt or a reading of its own
  int line = 0;  ///< of a text file, from 1; 0 if no single line is at fault
};

using Problems = std::vector<Problem>;

/// "line 12: field: found X, expected Y", one line, without the file's name; without the line if there is none.
std::string to_string(const Problem& problem);

/// @throws Error naming `file` and every fatal problem of the list; does nothing if there is none.
void throw_if_fatal(const std::string& file, const Problems& problems);

}  // namespace gonio
