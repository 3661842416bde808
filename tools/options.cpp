#include <gonio/mapping/error.h>
#include <gonio/tools/options.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>

namespace gonio {

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
      throw CLI::ValidationError(name, "found '" + text + "', expected zero, fill or reject");
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

std::vector<StackOptions> ChartChoice::candidates(const StackOptions& size) const {
  std::vector<StackOptions> result;
  for (const Chart chart : charts) {
    StackOptions options = size;
    options.chart = chart;
    options.interpolation = interpolation.value_or(
        chart == Chart::half ? Interpolation::blend : Interpolation::displacement);
    result.push_back(options);
  }
  return result;
}

void add_chart_options(CLI::App& verb, ChartChoice& choice) {
  verb.add_option_function<std::string>(
          "--chart",
          [&choice](const std::string& text) {
            if (text == "auto") return;
            for (const Chart chart : charts) {
              if (text == to_string(chart)) choice.charts = {chart};
            }
          },
          "What diagrams tabulate: outgoing directions, half vectors, or what measures better")
      ->check(CLI::IsMember({"outgoing", "half", "auto"}))
      ->type_name("outgoing|half|auto")
      ->default_str("auto");
  verb.add_option_function<std::string>(
          "--interpolation",
          [&choice](const std::string& text) {
            choice.interpolation =
                text == "blend" ? Interpolation::blend : Interpolation::displacement;
          },
          "Between incident angles [displacement for outgoing, blend for half]")
      ->check(CLI::IsMember({"displacement", "blend"}))
      ->type_name("displacement|blend");
}

void add_stack_options(CLI::App& verb, StackOptions& stack) {
  const char* const group = "Size of a stack: it grows until one of these is met";
  verb.add_option("--incident", stack.incident, "At most this many incident angles")
      ->capture_default_str()
      ->group(group);
  verb.add_option_function<std::string>(
          "--bytes", [&stack](const std::string& text) { stack.bytes = parse_bytes("--bytes", text); },
          "At most this much memory for the diagrams (once there are seven), such as 1MiB")
      ->type_name("SIZE")
      ->default_str(std::to_string(stack.bytes / 1024) + "KiB")
      ->group(group);
  verb.add_option("--tolerance", stack.tolerance, "Relative variance that is good enough")
      ->capture_default_str()
      ->group(group);
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
    if (parsed.ec == std::errc() && unit == name && number <= SIZE_MAX / factor)
      return number * factor;
  }
  throw CLI::ValidationError(option,
                             "found '" + text + "', expected bytes such as 500000 or 480KiB");
}

std::string checked_extension(const std::filesystem::path& output,
                              const std::vector<std::string>& extensions) {
  std::string extension = output.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
    std::string expected;
    for (const std::string& known : extensions) expected += (expected.empty() ? "" : ", ") + known;
    throw Error(output.string() + ": extension: found " + (extension.empty() ? "none" : extension) +
                ", expected one of " + expected);
  }
  const std::filesystem::path folder = output.parent_path();
  std::error_code code;
  if (!folder.empty() && !std::filesystem::is_directory(folder, code)) {
    throw Error(output.string() + ": folder: found none, expected " + folder.string());
  }
  return extension;
}

}  // namespace gonio
