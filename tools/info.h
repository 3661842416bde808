#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio info FILE...`: what tables, stack files and fits hold.
void add_info(CLI::App& app);

}  // namespace gonio
