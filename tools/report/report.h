#pragma once

#include <CLI/CLI.hpp>

namespace gonio {

/// Adds the verb `gonio report`.
void add_report(CLI::App& app);

}  // namespace gonio
