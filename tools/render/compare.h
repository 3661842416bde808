#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// The verb `compare`.
void add_compare(CLI::App& app);

}  // namespace gonio
