#include "tools/cli/options.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>

#include <CLI/CLI.hpp>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/number.h"

namespace gonio {

namespace {

const char* const by_hand = "Size of a stack by hand: it grows until one of these is met";

}  // namespace

const char* to_string(CellPolicy policy) noexcept {
  switch (policy) {
    case CellPolicy::zero:
      return "zero";
    case CellPolicy::fill:
      return "fill";
    default:
      return "reject";
  }
}

void add_cell_policies(CLI::App& verb, CellPolicies& policies) {
  const auto add = [&](const std::string& name, CellPolicy& policy, const std::string& cells) {
    const auto assign = [name, &policy](const std::string& text) {
      for (const CellPolicy known : {CellPolicy::zero, CellPolicy::fill, CellPolicy::reject}) {
        if (text != to_string(known)) continue;
        policy = known;
        return;
      }
      throw CLI::ValidationError(name, "found '" + text + "', expected " + one_of({"zero", "fill", "reject"}, text));
    };
    verb.add_option_function<std::string>(name, assign, cells)
        ->type_name("zero|fill|reject")
        ->default_str(to_string(policy))
        ->group("Cells that cannot be a BRDF value");
  };
  add("--negative", policies.negative, "Cells with a negative value");
  add("--nonfinite", policies.nonfinite, "Cells with NaN or infinity");
  add("--missing", policies.missing, "Cells marked as not measured (MERL: negative)");
}

void add_stack_request(CLI::App& verb, StackRequest& request) {
  const char* const size = "Size of a stack: a result, not a parameter";
  verb.add_option_function<double>(
          "--max-variance", [&request](double value) { request.max_variance = value; },
          "The fewest bytes with at most this relative variance at every angle up to 80 degrees [0.003 if there is "
          "no --budget]")
      ->type_name("X")
      ->group(size);
  verb.add_option_function<std::string>(
          "--budget", [&request](const std::string& text) { request.budget = parse_bytes("--budget", text); },
          "At most this much memory [256KiB]; without --max-variance, the least evaluation error within it. With "
          "--scene, "
          "of all stacks together")
      ->type_name("SIZE")
      ->group(size);
  verb.add_option_function<std::string>(
          "--chart",
          [&request](const std::string& text) {
            request.chart.reset();  // "auto"
            for (const Chart chart : charts)
              if (text == to_string(chart)) request.chart = chart;
          },
          "What diagrams tabulate: outgoing directions, half vectors, or what measures better")
      ->check(known_word({"outgoing", "half", "auto"}))
      ->type_name("outgoing|half|auto")
      ->default_str("auto")
      ->group(size);
  verb.add_option("--front", request.front,
                  "Also write all forms that were measured as JSON: bytes, ns, relvar, eval_error, and which is chosen")
      ->type_name("FILE")
      ->group(size);
  verb.add_option_function<std::string>(
          "--interpolation",
          [&request](const std::string& text) {
            request.interpolation = text == "blend" ? Interpolation::blend : Interpolation::displacement;
          },
          "Sizes by hand, and this between incident angles [displacement]")
      ->check(known_word({"displacement", "blend"}))
      ->type_name("displacement|blend")
      ->group(by_hand);
  add_stack_options(verb, request.by_hand);
}

void add_stack_options(CLI::App& verb, BsdfOptions& stack) {
  verb.add_option("--incident", stack.incident, "At most this many incident angles")
      ->capture_default_str()
      ->group(by_hand);
  verb.add_option_function<std::string>(
          "--bytes", [&stack](const std::string& text) { stack.budget = parse_bytes("--bytes", text); },
          "At most this much memory for the diagrams (once there are seven), such as 1MiB")
      ->type_name("SIZE")
      ->default_str(std::to_string(stack.budget / 1024) + "KiB")
      ->group(by_hand);
  verb.add_option_function<double>(
          "--tolerance",
          [&stack](double value) {
            if (!(value > 0))
              throw CLI::ValidationError("--tolerance", "found " + number(value, 4) + ", expected more than 0");
            stack.max_variance = value;
          },
          "Relative variance that is good enough")
      ->default_str(number(*stack.max_variance, 4))
      ->group(by_hand);
}

CLI::Validator known_word(const std::vector<std::string>& known) {
  const auto check = [known](const std::string& text) {
    const bool is_known = std::find(known.begin(), known.end(), text) != known.end();
    return is_known ? std::string() : "found '" + text + "', expected " + one_of(known, text);
  };
  return CLI::Validator(check, "");
}

std::pair<int, int> parse_grid(const std::string& option, const std::string& text) {
  int m = 0, n = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, m);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == 'x') {
    const auto second = std::from_chars(first.ptr + 1, end, n);
    if (second.ec == std::errc() && second.ptr == end && m > 0 && n > 0) return {m, n};
  }
  throw CLI::ValidationError(option, "found '" + text + "', expected two numbers such as 40x30");
}

std::size_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr std::pair<const char*, std::size_t> units[] = {
      {"", 1},          {"B", 1},         {"kB", 1000},       {"MB", 1000 * 1000},
      {"KiB", 1 << 10}, {"MiB", 1 << 20}, {"GB", 1000000000}, {"GiB", 1 << 30}};
  std::size_t number = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  const std::string unit(parsed.ptr, end);
  for (const auto& [name, factor] : units) {
    if (parsed.ec == std::errc() && unit == name && number <= SIZE_MAX / factor) return number * factor;
  }
  throw CLI::ValidationError(option, "found '" + text + "', expected bytes such as 500000 or 480KiB");
}

std::string checked_extension(const std::filesystem::path& output, const std::vector<std::string>& extensions) {
  std::string extension = output.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
    throw Error(output.string() + ": extension: found " + (extension.empty() ? "none" : extension) + ", expected " +
                one_of(extensions, extension));
  }
  if (output.has_parent_path()) check_folder(output.parent_path());
  return extension;
}

}  // namespace gonio
