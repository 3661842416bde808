#pragma once

#include <CLI/App.hpp>

namespace gonio {

/// `gonio synth MODEL -o OUT`: a table computed from an analytic model.
void add_synth(CLI::App& app);

}  // namespace gonio
