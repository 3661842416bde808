#pragma once

#include <functional>

namespace gonio {

/// Called now and then with the share of the work that is done, in [0, 1]; from one thread at a time.
using Progress = std::function<void(double)>;

}  // namespace gonio
