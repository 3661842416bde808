#pragma once

#include <gonio/brdf/build.h>

#include <CLI/App.hpp>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The options --negative, --nonfinite and --missing of a verb that loads tables.
/// `policies` must outlive the parsing.
void add_cell_policies(CLI::App& verb, CellPolicies& policies);

/// "zero", "fill" or "reject".
const char* to_string(CellPolicy policy) noexcept;

/// The charts that --chart asks for: one, or both for `auto`.
/// `choice` must outlive the parsing.
struct ChartChoice {
  std::vector<Chart> charts{Chart::outgoing, Chart::half};
  std::optional<Interpolation> interpolation;  ///< of --interpolation

  /// What is to be built: in each chart with the interpolation asked for, or the one that suits the
  /// chart, displacement for outgoing and blend for half.
  std::vector<StackOptions> candidates(const StackOptions& size) const;
};
void add_chart_options(CLI::App& verb, ChartChoice& choice);

/// The options --incident, --bytes and --tolerance of a verb that builds stacks.
/// `stack` must outlive the parsing.
void add_stack_options(CLI::App& verb, StackOptions& stack);

/// Two positive numbers, as in "40x30". @throws CLI::ValidationError naming `option`
std::pair<int, int> parse_grid(const std::string& option, const std::string& text);

/// A number of bytes, as in "5000", "480KiB" or "1MB". @throws CLI::ValidationError naming `option`
std::size_t parse_bytes(const std::string& option, const std::string& text);

/// The extension of an output file in lower case. Called before the work, so that it is not in
/// vain.
/// @throws Error if it is none of `extensions`, or if the folder does not exist.
std::string checked_extension(const std::filesystem::path& output,
                              const std::vector<std::string>& extensions);

}  // namespace gonio
