#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio stability -o DIR`: textbook formulas beside the library's own, and where which of them fails.
void add_stability(CLI::App& app);

}  // namespace gonio
