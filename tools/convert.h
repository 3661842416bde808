#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio convert IN OUT`: a table as a stack file, MERL, MBSDF or RGL; a stack file rewritten or as RGL.
/// `gonio convert IN... FOLDER`: each of them.
void add_convert(CLI::App& app);

}  // namespace gonio
