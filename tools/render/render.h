#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// The verb `render`.
void add_render(CLI::App& app);

}  // namespace gonio
