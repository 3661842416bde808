#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace gonio {

/// Adds the verb `gonio report`. `arguments`: those of the program, for the report's provenance.
void add_report(CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace gonio
