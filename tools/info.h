#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio info FILE`: what a table or a stack file holds.
void add_info(CLI::App& app);

}  // namespace gonio
