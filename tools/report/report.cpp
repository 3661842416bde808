#include <gonio/tools/report/report.h>

#include <gonio/mapping/error.h>
#include <gonio/mapping/light/exr/light_exr.h>
#include <gonio/tools/options.h>
#include <gonio/tools/progress.h>
#include <gonio/tools/report/measure_material.h>
#include <gonio/tools/report/merge.h>
#include <gonio/tools/report/provenance.h>
#include <gonio/tools/report/write_report.h>
#include <gonio/tools/stability/summary.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace gonio {

namespace {

LightReport measure_light(const std::filesystem::path& path) {
  Deviations ignored;
  const Luminaire light = load_any_light(path, {}, ignored);
  return {path.stem().string(), path.string(), light.format, std::filesystem::file_size(path), sha256_of(path), flux(light.diagram), emission_quality(light.diagram)};
}

}  // namespace

void add_report(CLI::App& app, const std::vector<std::string>& arguments) {
  struct Options {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path directory;
    std::filesystem::path stability;
    bool merge = false;
    ReportOptions report;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("report", "Measure how well materials are sampled, by every method");
  verb->add_option("IN", options->inputs, "Tables (MERL, RGL, MBSDF), stack files, fit.json, or luminaires (IES, EULUMDAT, light EXR)")->required();
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
      ->default_str(std::to_string(options->report.stack.meridians) + "x" + std::to_string(options->report.stack.parallels));
  add_stack_options(*verb, options->report.stack);
  add_cell_policies(*verb, options->report.policies);
  verb->footer(
      "Angles 2, 10, 30, 50, 70, 80 and 85 degrees. Methods: uniform, cosine; rgl, the own warps of RGL files; nearest, mixture and\n"
      "displacement, one stack of the size given above; blend, the default stack of a table; compact, the smallest compact BSDF of\n"
      "relative variance 0.01; lobes1, lobes2 and lobes3, fitted GGX lobes; and displacement_small, a stack of about the lobes' bytes.\n"
      "A stack file is measured as it is. Luminaires: relative variance and speed of emission.\n\n"
      "Examples:\n"
      "  gonio report chrome.binary -o report\n"
      "  gonio report measured/*.bsdf --bytes 128KiB -o report\n"
      "  gonio report --merge reports/*/report.json -o overview");
  verb->callback([options, arguments] {
    if (options->merge) {
      write_merged_report(options->directory, options->inputs);
      std::cout << "written: " << (options->directory / "report.html").string() << ", report.md, report.json\n";
      return;
    }
    Report report;
    report.command = command_line(arguments);
    if (!options->stability.empty()) report.stability = read_stability(options->stability);
    report.machine = this_machine();
    for (std::size_t k = 0; k < options->inputs.size(); ++k) {
      ProgressLine line("report " + options->inputs[k].filename().string() + " (" + std::to_string(k + 1) + " of " +
                        std::to_string(options->inputs.size()) + ")");
      if (is_light_file(options->inputs[k])) {
        report.lights.push_back(measure_light(options->inputs[k]));
        continue;
      }
      report.materials.push_back(
          measure_material(options->inputs[k], options->report, [&](double share) { line.update(share); }));
      report.materials.back().sha256 = sha256_of(options->inputs[k]);
    }
    write_report(options->directory, report);
    print_summary(std::cout, report);
    std::cout << "written: " << (options->directory / "report.html").string() << ", report.md, report.json\n";
  });
}

}  // namespace gonio
