#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio ndf IN -o DIR`: the normal distribution of a table, or of an image, and its shadowing.
void add_ndf(CLI::App& app);

}  // namespace gonio
