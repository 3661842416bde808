#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio light info|validate|convert|plot|solid|sample|compare FILE...`: photometric files.
void add_light(CLI::App& app);

}  // namespace gonio
