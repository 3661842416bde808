#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>

#include <gonio/brdf/build/stack/build_stack.h>

namespace gonio {

/// The options --negative, --nonfinite and --missing of a verb that loads tables.
/// `policies` must outlive the parsing.
void add_cell_policies(CLI::App& verb, CellPolicies& policies);

/// "zero", "fill" or "reject".
const char* to_string(CellPolicy policy) noexcept;

/// How a table becomes a stack file: as small as a variance allows, as good as a number of bytes allows, or of
/// sizes given by hand.
struct StackRequest {
  std::optional<Chart> chart;                  ///< of --chart; none: `auto`
  std::optional<double> max_variance;          ///< of --max-variance
  std::optional<std::size_t> budget;           ///< of --budget
  std::string front;                           ///< of --front
  std::vector<std::string> comments;           ///< of --comment, a line each
  std::optional<Interpolation> interpolation;  ///< of --interpolation, by hand
  BsdfOptions by_hand;
};

/// The options of a StackRequest; `request` must outlive the parsing. --grid, which means something else for other
/// formats, is not among them.
void add_stack_request(CLI::App& verb, StackRequest& request);

/// Their names.
inline constexpr std::initializer_list<const char*> stack_options = {
    "--chart", "--max-variance", "--budget", "--front", "--interpolation", "--incident", "--bytes", "--tolerance"};

/// The options --incident, --bytes and --tolerance of a verb that builds stacks.
/// `stack` must outlive the parsing.
void add_stack_options(CLI::App& verb, BsdfOptions& stack);

/// The check of an option whose value is one of these words.
CLI::Validator known_word(const std::vector<std::string>& known);

/// Two positive numbers, as in "40x30". @throws CLI::ValidationError naming `option`
std::pair<int, int> parse_grid(const std::string& option, const std::string& text);

/// A number of bytes, as in "5000", "480KiB" or "1MB". @throws CLI::ValidationError naming `option`
std::size_t parse_bytes(const std::string& option, const std::string& text);

/// The extension of an output file in lower case. Called before the work, so that it is not in
/// vain.
/// @throws Error if it is none of `extensions`, or if the folder does not exist.
std::string checked_extension(const std::filesystem::path& output, const std::vector<std::string>& extensions);

}  // namespace gonio
