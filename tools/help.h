#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace gonio {

/// The verb `help`: --help of the program, or of another verb, under one more name.
void add_help(CLI::App& app);

/// The names of an app's own verbs.
std::vector<std::string> verb_names(const CLI::App& app);

}  // namespace gonio
