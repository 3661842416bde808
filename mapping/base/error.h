#pragma once

#include <stdexcept>

namespace gonio {

/// The one exception type that leaves the library. The message names the file (where there is one),
/// the field, what was found and what was expected.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace gonio
