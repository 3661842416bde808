#include <gonio/brdf/choose_stack.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/sniff.h>
#include <gonio/brdf/write.h>
#include <gonio/fitting/synth.h>
#include <gonio/mapping/error.h>
#include <gonio/tools/convert.h>
#include <gonio/tools/input.h>
#include <gonio/tools/options.h>
#include <gonio/tools/progress.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <tuple>

namespace gonio {
namespace {

constexpr int colour_side = 16;

struct Options {
  std::string in, out, grid;
  int n_phi_d = 360;
  StackOptions stack;
  ChartChoice chart;
  CellPolicies policies;
};

/// Options that would have no effect are refused.
void refuse(const CLI::App& verb, std::initializer_list<const char*> options,
            const std::string& why) {
  for (const char* option : options) {
    if (verb.count(option) > 0)
      throw Error(std::string(option) + ": found one, expected none: " + why);
  }
}

void refuse_policies(const CLI::App& verb, const std::string& why) {
  refuse(verb, {"--negative", "--nonfinite", "--missing"}, why);
}

/// What was built, the best first.
std::string describe(const std::vector<RatedStack>& rated) {
  std::string text;
  for (const RatedStack& r : rated) {
    char number[32];
    std::snprintf(number, sizeof(number), "%.2g", r.relvar);
    text += (text.empty() ? "chart " : "; not ") + std::string(to_string(r.grid.chart)) + ", " +
            to_string(r.interpolation) + ": mean relvar " + number;
  }
  return text + " (2 to 80 degrees)";
}

void table_to_stack(const Options& options) {
  StackFile file;
  std::string built;
  {
    ProgressLine progress("building the stack of " + options.in);
    const BrdfTable table = load_input(options.in, options.policies);
    const std::vector<RatedStack> rated =
        choose_stack(table, options.chart.candidates(options.stack),
                     [&](double share) { progress.update(share); });
    built = describe(rated);
    const Stack<float> stack(rated.front().grid, rated.front().interpolation);
    file.diagrams = stack.grid();
    file.interpolation = stack.interpolation();
    file.colour = Colour::from_table(table, stack, colour_side);
    file.name = table.info().name;
    file.source = std::filesystem::path(options.in).filename().string();
  }
  save_stack(options.out, file);
  std::printf("%s\n", built.c_str());
}

void convert_stack(const CLI::App& verb, const Options& options, const std::string& extension) {
  if (extension != ".exr") {
    throw Error(options.in +
                ": format: found a stack file, expected a table (MERL, RGL or MBSDF) to write " +
                extension);
  }
  refuse(verb, {"--chart", "--interpolation", "--incident", "--grid", "--bytes", "--tolerance", "--phi-d"},
         "a stack file keeps its diagrams");
  refuse_policies(verb, "a stack file has no such cells");
  save_stack(options.out, load_stack(options.in));
}

void table_to_merl(const CLI::App& verb, const Options& options) {
  const ProgressLine progress("writing " + options.out);
  if (sniff_format(options.in) == TableFormat::merl) {
    refuse_policies(verb, "MERL to MERL keeps the values as they are stored");
    refuse(verb, {"--phi-d"}, "MERL to MERL keeps the values as they are stored");
    load_table(options.in);  // what cannot be used is not copied either
    write_merl(options.out, read_merl(options.in));
  } else {
    write_table_as_merl(load_table(options.in, options.policies), options.out, options.n_phi_d);
  }
}

void table_to_mbsdf(const CLI::App& verb, const Options& options) {
  const ProgressLine progress("writing " + options.out);
  if (sniff_format(options.in) == TableFormat::mbsdf && options.grid.empty()) {
    refuse_policies(verb, "MBSDF to MBSDF without --grid keeps the values as they are stored");
    load_table(options.in);  // what cannot be used is not copied either
    write_mbsdf(options.out, read_mbsdf(options.in));
    return;
  }
  const auto [thetas, phis] = parse_grid("--grid", options.grid.empty() ? "90x180" : options.grid);
  write_table_as_mbsdf(load_table(options.in, options.policies), options.out, thetas, phis);
}

void model_to_table(const CLI::App& verb, const Options& options, const std::string& extension) {
  refuse_policies(verb, "a model has no such cells");
  refuse(verb, {"--phi-d"}, "a model is reciprocal, so that 180 bins hold all of it");
  const LobeModel model = load_model(options.in);
  const ProgressLine progress("writing " + options.out);
  if (extension == ".binary") {
    write_merl(options.out, synthesize_merl(model));
    return;
  }
  const auto [thetas, phis] = parse_grid("--grid", options.grid.empty() ? "90x180" : options.grid);
  if (thetas > max_grid_side || phis > max_grid_side) {
    throw Error("--grid: found " + options.grid + ", expected at most " +
                std::to_string(max_grid_side) + " thetas and phis");
  }
  write_mbsdf(options.out, synthesize_grid(model, thetas, phis));
}

void convert(const CLI::App& verb, Options& options) {
  const std::string extension = checked_extension(options.out, {".exr", ".binary", ".mbsdf"});
  if (extension != ".binary") refuse(verb, {"--phi-d"}, "only MERL has it");
  if (is_exr(options.in)) {
    convert_stack(verb, options, extension);
    return;
  }
  if (extension == ".exr") {
    if (!options.grid.empty()) {
      std::tie(options.stack.meridians, options.stack.parallels) =
          parse_grid("--grid", options.grid);
    }
    table_to_stack(options);
    return;
  }
  refuse(verb, {"--chart", "--interpolation", "--incident", "--bytes", "--tolerance"}, "only a stack file has diagrams");
  if (extension == ".binary") {
    refuse(verb, {"--grid"}, "the cells of MERL are fixed");
  }
  if (is_model_file(options.in)) {
    model_to_table(verb, options, extension);
  } else if (extension == ".binary") {
    table_to_merl(verb, options);
  } else {
    table_to_mbsdf(verb, options);
  }
}

}  // namespace

void add_convert(CLI::App& app) {
  auto options = std::make_shared<Options>();
  StackOptions& stack = options->stack;
  CLI::App* verb = app.add_subcommand(
      "convert", "A table as a stack file (.exr), MERL (.binary) or MBSDF (.mbsdf)");
  verb->add_option("IN", options->in,
                   "MERL, RGL or MBSDF table, stack file, or fit.json, known by its content")
      ->required();
  verb->add_option("OUT", options->out,
                   "File to write; its extension, .exr, .binary or .mbsdf, is its format")
      ->required();
  verb->add_option("--grid", options->grid,
                   ".exr: at most M meridians and N parallels in a diagram [" +
                       std::to_string(stack.meridians) + "x" + std::to_string(stack.parallels) +
                       "]; .mbsdf: M thetas and N phis [90x180]")
      ->type_name("MxN");
  add_chart_options(*verb, options->chart);
  add_stack_options(*verb, stack);
  verb->add_option("--phi-d", options->n_phi_d,
                   ".binary: bins of phi_d, 360 or 180; most other programs read 180 alone, which "
                   "averages f_r(wi, wo) and f_r(wo, wi)")
      ->check(CLI::IsMember({180, 360}))
      ->type_name("BINS")
      ->capture_default_str();
  add_cell_policies(*verb, options->policies);
  verb->footer(
      "MERL to MERL, and MBSDF to MBSDF without --grid, keep the values as they are stored.\n"
      "Anything else is sampled at the cell centres of OUT. A fit.json is a table of MERL's cells\n"
      "for a stack, and the model itself at the cell centres of a table.\n\n"
      "Examples:\n"
      "  gonio convert chrome.binary chrome.exr\n"
      "  gonio convert satin.bsdf small.exr --grid 16x16 --bytes 64KiB\n"
      "  gonio convert satin.bsdf satin.exr --chart half\n"
      "  gonio convert satin.bsdf satin.binary\n"
      "  gonio convert satin.bsdf satin.mbsdf --grid 45x90\n"
      "  gonio convert fit.json fit.exr");
  verb->callback([options, verb] { convert(*verb, *options); });
}

}  // namespace gonio
