#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/light/exr/light_exr.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/failures.h"
#include "tools/cli/input.h"
#include "tools/cli/options.h"
#include "tools/cli/progress.h"
#include "tools/report/measure/measure_material.h"
#include "tools/report/merge.h"
#include "tools/report/provenance.h"
#include "tools/report/write_report.h"
#include "tools/stability/summary.h"
#include "tools/verbs/verbs.h"

namespace gonio {

namespace {

struct Options {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path directory;
  std::filesystem::path stability;
  bool merge = false;
  ReportOptions report;
};

LightReport measure_light(const std::filesystem::path& path) {
  Problems ignored;
  const Luminaire light = load_any_light(path, {}, ignored);
  return {path.stem().string(),
          path.string(),
          light.format,
          std::filesystem::file_size(path),
          sha256_of(path),
          flux(light.diagram),
          emission_quality(light.diagram)};
}

std::string of_all(std::size_t k, std::size_t count) {
  return " (" + std::to_string(k + 1) + " of " + std::to_string(count) + ")";
}

/// Those that load: measuring takes long, and is not begun before all are known.
std::vector<std::filesystem::path> usable_inputs(const Options& options, Failures& failures) {
  std::vector<std::filesystem::path> usable;
  for (std::size_t k = 0; k < options.inputs.size(); ++k) {
    const std::filesystem::path& input = options.inputs[k];
    const ProgressLine line("reading " + input.string() + of_all(k, options.inputs.size()));
    const bool loads = failures.survives([&] {
      Problems ignored;
      if (is_light_file(input))
        load_any_light(input, {}, ignored);
      else if (is_exr(input))
        StackBsdf(load_stack(input).bsdf);
      else
        load_input(input, options.report.policies);
    });
    if (loads) usable.push_back(input);
  }
  return usable;
}

void measure(const std::filesystem::path& input, const ReportOptions& options, ProgressLine& line, Report& report) {
  if (is_light_file(input)) {
    report.lights.push_back(measure_light(input));
    return;
  }
  MaterialReport material = measure_material(input, options, [&](double share) { line.update(share); });
  material.sha256 = sha256_of(input);
  add_material(report, std::move(material));
}

void print_written_report(const std::filesystem::path& directory) {
  std::cout << "written: " << (directory / "report.html").string() << ", report.md, report.json\n";
}

/// Files of the folder that have the names of all reports.
void check_outputs(const Options& options) {
  std::vector<std::filesystem::path> inputs = options.inputs;
  if (!options.stability.empty()) inputs.push_back(options.stability);
  check_not_input(options.directory, {"report.html", "report.md", "report.json"}, inputs);
}

void report_verb(const Options& options, const std::vector<std::string>& arguments) {
  check_outputs(options);
  Failures failures;
  if (options.merge) {
    write_merged_report(options.directory, options.inputs, failures);
    print_written_report(options.directory);
    failures.throw_any(options.inputs.size());
    return;
  }
  Report report;
  report.command = command_line(arguments);
  if (!options.stability.empty()) report.stability = read_stability(options.stability);
  report.machine = this_machine();
  const std::vector<std::filesystem::path> inputs = usable_inputs(options, failures);
  if (!inputs.empty()) make_folder(options.directory, "report.html");
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    ProgressLine line("report " + inputs[k].filename().string() + of_all(k, inputs.size()));
    failures.survives([&] { measure(inputs[k], options.report, line, report); });
  }
  if (report.materials.empty() && report.lights.empty()) failures.throw_any(options.inputs.size());
  write_report(options.directory, report);
  print_summary(std::cout, report);
  print_written_report(options.directory);
  failures.throw_any(options.inputs.size());
}

}  // namespace

void add_report(CLI::App& app, const std::vector<std::string>& arguments) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("report", "Measure how well materials are sampled, by every method");
  verb->add_option("IN", options->inputs,
                   "Tables (MERL, RGL, MBSDF), stack files, fit.json, or luminaires (IES, EULUMDAT, light EXR)")
      ->required();
  verb->add_option("-o,--output", options->directory, "Folder for report.html, report.md and report.json")->required();
  verb->add_option("--stability", options->stability, "A stability.json of gonio stability, to be shown as well");
  verb->add_flag("--merge", options->merge, "IN are report.json files: writes them as one report, without measuring");
  verb->add_option_function<std::string>(
          "--grid",
          [options](const std::string& text) {
            std::tie(options->report.stack.meridians, options->report.stack.parallels) = parse_grid("--grid", text);
          },
          "At most M meridians and N parallels in a diagram")
      ->type_name("MxN")
      ->default_str(std::to_string(options->report.stack.meridians) + "x" +
                    std::to_string(options->report.stack.parallels));
  add_stack_options(*verb, options->report.stack);
  add_cell_policies(*verb, options->report.policies);
  verb->footer(
      "Angles 2, 10, 30, 50, 70, 80 and 85 degrees. Methods: uniform, cosine; rgl, the own warps of RGL files; "
      "nearest, mixture and\n"
      "displacement, one stack of the size given above; blend, the default stack of a table; compact, the smallest "
      "compact BSDF of\n"
      "relative variance 0.01; lobes1, lobes2 and lobes3, fitted GGX lobes; and displacement_small, a stack of about "
      "the lobes' bytes.\n"
      "A stack file is measured as it is. Luminaires: relative variance and speed of emission.\n\n"
      "Examples:\n"
      "  gonio report chrome.binary -o report\n"
      "  gonio report measured/*.bsdf --bytes 128KiB -o report\n"
      "  gonio report --merge reports/*/report.json -o overview");
  verb->callback([options, arguments] { report_verb(*options, arguments); });
}

}  // namespace gonio
