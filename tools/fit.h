#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// Adds the verb `gonio fit`.
void add_fit(CLI::App& app);

}  // namespace gonio
