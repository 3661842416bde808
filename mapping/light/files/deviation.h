#pragma once

#include <string>
#include <vector>

namespace gonio {

/// One place where a photometric file departs from its standard, or where it had to be interpreted.
/// The file loads nevertheless; what makes a file unusable is thrown as Error.
struct Deviation {
  int line;              ///< in the file, from 1; 0 if no single line is at fault
  std::string field;     ///< part of the file
  std::string found;     ///< what it holds
  std::string expected;  ///< what it should hold
};

/// "line 12: field: found X, expected Y"; without the line if there is none.
std::string to_string(const Deviation& deviation);

using Deviations = std::vector<Deviation>;

}  // namespace gonio
