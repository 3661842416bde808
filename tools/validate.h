#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio validate FILE...`: every problem of tables and stack files.
void add_validate(CLI::App& app);

}  // namespace gonio
