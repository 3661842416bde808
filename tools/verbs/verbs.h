#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace gonio {

// A function a verb, in the file of that name: it adds the verb to the program.

void add_compare(CLI::App& app);
void add_convert(CLI::App& app);
void add_fit(CLI::App& app);
void add_help(CLI::App& app);
void add_info(CLI::App& app);
void add_light(CLI::App& app);
void add_ndf(CLI::App& app);
void add_render(CLI::App& app);
/// @param arguments those of the program, which the report states
void add_report(CLI::App& app, const std::vector<std::string>& arguments);
void add_stability(CLI::App& app);
void add_synth(CLI::App& app);
void add_validate(CLI::App& app);

/// The names of an app's own verbs.
std::vector<std::string> verb_names(const CLI::App& app);

}  // namespace gonio
