#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio convert IN OUT`: a table as a stack file, MERL or MBSDF; a stack file rewritten.
void add_convert(CLI::App& app);

}  // namespace gonio
