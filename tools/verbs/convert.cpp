#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <CLI/CLI.hpp>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/formats/sniff.h>
#include <gonio/brdf/resample/table_resample.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/failures.h"
#include "tools/cli/input.h"
#include "tools/cli/options.h"
#include "tools/cli/progress.h"
#include "tools/cli/written.h"
#include "tools/convert/convert_rgl.h"
#include "tools/convert/convert_scene.h"
#include "tools/convert/convert_stack.h"
#include "tools/convert/stack_comments.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

struct Options {
  std::vector<std::string> paths;  // inputs, and at last the output
  std::string format = "exr";      // of the files in a folder
  std::string in, out, grid;
  std::string scene, scene_out;
  int n_phi_d = 360;
  StackRequest stack;
  CellPolicies policies;
  bool rgb = false;
};

/// Options that would have no effect are refused.
void refuse(const CLI::App& verb, std::initializer_list<const char*> options, const std::string& why) {
  for (const char* option : options) {
    if (verb.count(option) > 0) throw Error(std::string(option) + ": found one, expected none: " + why);
  }
}

void refuse_policies(const CLI::App& verb, const std::string& why) {
  refuse(verb, {"--negative", "--nonfinite", "--missing"}, why);
}

void stack_to_stack(const CLI::App& verb, const Options& options, const std::string& extension) {
  if (extension != ".exr") {
    throw Error(options.in + ": format: found a stack file, expected a table (MERL, RGL or MBSDF) to write " +
                extension);
  }
  refuse(verb, stack_options, "a stack file keeps its diagrams");
  refuse(verb, {"--grid", "--phi-d"}, "a stack file keeps its diagrams");
  refuse_policies(verb, "a stack file has no such cells");
  StackFile file = load_stack(options.in);
  for (const std::string& comment : options.stack.comments) add_comment(file.comments, comment);
  save_stack(options.out, file);
}

void table_to_merl(const CLI::App& verb, const Options& options) {
  const ProgressLine progress("writing " + options.out);
  if (sniff_format(options.in) == TableFormat::merl) {
    refuse_policies(verb, "MERL to MERL keeps the values as they are stored");
    refuse(verb, {"--phi-d"}, "MERL to MERL keeps the values as they are stored");
    load_input(options.in);  // what cannot be used is not copied either
    write_merl(options.out, read_merl(options.in));
  } else {
    write_table_as_merl(load_input(options.in, options.policies), options.out, options.n_phi_d);
  }
}

void table_to_mbsdf(const CLI::App& verb, const Options& options) {
  const ProgressLine progress("writing " + options.out);
  if (sniff_format(options.in) == TableFormat::mbsdf && options.grid.empty()) {
    refuse_policies(verb, "MBSDF to MBSDF without --grid keeps the values as they are stored");
    load_input(options.in);  // what cannot be used is not copied either
    write_mbsdf(options.out, read_mbsdf(options.in));
    return;
  }
  const auto [thetas, phis] = parse_grid("--grid", options.grid.empty() ? "90x180" : options.grid);
  write_table_as_mbsdf(load_input(options.in, options.policies), options.out, thetas, phis);
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
    throw Error("--grid: found " + options.grid + ", expected at most " + std::to_string(max_grid_side) +
                " thetas and phis");
  }
  write_mbsdf(options.out, synthesize_mbsdf(model, thetas, phis));
}

void any_to_rgl(const CLI::App& verb, const Options& options) {
  refuse(verb, stack_options, "the size of a .bsdf follows from the material");
  refuse(verb, {"--grid", "--phi-d"}, "the size of a .bsdf follows from the material");
  if (is_exr(options.in) || is_model_file(options.in) || sniff_format(options.in) == TableFormat::rgl) {
    refuse_policies(verb, "only the cells of MERL and MBSDF are sampled anew");
  }
  convert_to_rgl(options.in, options.out, options.policies, options.rgb);
}

void scene_to_stacks(const CLI::App& verb, const Options& options) {
  for (const char* needed : {"--budget", "--output"})
    if (verb.count(needed) == 0) throw CLI::RequiredError(needed);
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_name();
    if (name != "--scene" && name != "--budget" && name != "--output")
      refuse(verb, {name.c_str()}, "--scene has its own");
  }
  convert_scene(options.scene, *options.stack.budget, options.scene_out);
}

/// IN to OUT.
void convert_file(const CLI::App& verb, Options& options) {
  check_not_input(options.out, {options.in});
  const bool any_kind = std::filesystem::path(options.out).extension().empty() && options.stack.max_variance;
  const std::string extension = any_kind ? "" : checked_extension(options.out, {".exr", ".binary", ".mbsdf", ".bsdf"});
  if (extension != ".exr") refuse(verb, {"--comment"}, "only a stack file has comments: OUT.exr");
  if (extension == ".bsdf") {
    any_to_rgl(verb, options);
    print_written(options.out);
    return;
  }
  refuse(verb, {"--rgb"}, "only .bsdf may hold spectra");
  if (extension != ".binary") refuse(verb, {"--phi-d"}, "only MERL has it");
  if (is_exr(options.in)) {
    stack_to_stack(verb, options, extension);
    print_written(options.out);
    return;
  }
  if (extension == ".exr" || any_kind) {
    if (!options.grid.empty()) {
      std::tie(options.stack.by_hand.meridians, options.stack.by_hand.parallels) = parse_grid("--grid", options.grid);
    }
    table_to_stack(verb, options.in, options.out, options.stack, options.policies);
    return;
  }
  refuse(verb, stack_options, "only a stack file has diagrams");
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
  print_written(options.out);
}

/// One output for each input. @throws Error if two inputs would become one file.
std::vector<std::string> outputs_in(const std::filesystem::path& folder, const std::vector<std::string>& inputs,
                                    const std::string& extension) {
  std::map<std::string, std::string> taken;
  std::vector<std::string> outputs;
  for (const std::string& in : inputs) {
    const std::string name = std::filesystem::path(in).stem().string() + extension;
    const auto [other, added] = taken.emplace(name, in);
    if (!added)
      throw Error(in + ": would become " + (folder / name).string() + ", as " + other->second +
                  " does; nothing was written");
    outputs.push_back((folder / name).string());
  }
  return outputs;
}

void convert_each(const CLI::App& verb, Options& options, const std::vector<std::string>& inputs,
                  const std::string& folder) {
  refuse(verb, {"--front"}, "it describes one material");
  const std::vector<std::string> outputs = outputs_in(folder, inputs, "." + options.format);
  check_writable(outputs.front());
  Failures failures;
  for (std::size_t k = 0; k < inputs.size(); ++k)
    failures.survives([&] {
      options.in = inputs[k], options.out = outputs[k];
      convert_file(verb, options);
    });
  failures.throw_any(inputs.size());
}

void convert(const CLI::App& verb, Options& options) {
  if (verb.count("--scene") > 0) {
    scene_to_stacks(verb, options);
    return;
  }
  refuse(verb, {"--output"}, "only a scene has it");
  if (options.paths.size() < 2) throw CLI::RequiredError(options.paths.empty() ? "IN" : "OUT");
  const std::string out = options.paths.back();
  const std::vector<std::string> inputs(options.paths.begin(), options.paths.end() - 1);
  if (std::error_code code; std::filesystem::is_directory(out, code)) {
    convert_each(verb, options, inputs, out);
    return;
  }
  if (inputs.size() > 1 || std::filesystem::path(out).filename().empty()) check_folder(out);
  refuse(verb, {"--format"}, "the extension of OUT is the format");
  options.in = inputs.front(), options.out = out;
  convert_file(verb, options);
}

}  // namespace

void add_convert(CLI::App& app) {
  auto options = std::make_shared<Options>();
  const BsdfOptions& stack = options->stack.by_hand;
  CLI::App* verb =
      app.add_subcommand("convert", "A table as a stack file (.exr), MERL (.binary), MBSDF (.mbsdf) or RGL (.bsdf)");
  verb->add_option("IN", options->paths,
                   "MERL, RGL or MBSDF tables, stack files, or fit.json, known by their content, and as the last OUT: "
                   "the file to write; its extension, .exr, .binary, .mbsdf or .bsdf, is its format. With none and "
                   "--max-variance: .json if fitted lobes will do in less memory, else .exr. "
                   "Or a folder that exists: each input becomes a file of its name there")
      ->option_text("... OUT");
  verb->add_option("--format", options->format, "Of the files in a folder")
      ->check(known_word({"exr", "binary", "mbsdf", "bsdf"}))
      ->type_name("exr|binary|mbsdf|bsdf")
      ->capture_default_str();
  verb->add_option("--grid", options->grid,
                   ".exr: at most M meridians and N parallels in a diagram [" + std::to_string(stack.meridians) + "x" +
                       std::to_string(stack.parallels) + "]; .mbsdf: M thetas and N phis [90x180]")
      ->type_name("MxN");
  verb->add_option("--comment", options->stack.comments,
                   ".exr: a line for the comments of the file, after those that say how it was made: who measured it, "
                   "its licence. "
                   "May be given more than once")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  const char* const scene = "Stacks of all materials of a scene, in place of IN and OUT";
  verb->add_option("--scene", options->scene, "Scene manifest (JSON): materials, their files and shares")->group(scene);
  verb->add_option("-o,--output", options->scene_out, "Folder for the stack files and scene-budget.json")->group(scene);
  add_stack_request(*verb, options->stack);
  verb->add_option("--phi-d", options->n_phi_d,
                   ".binary: bins of phi_d, 360 or 180; most other programs read 180 alone, which "
                   "averages f_r(wi, wo) and f_r(wo, wi)")
      ->check(CLI::IsMember({180, 360}))
      ->type_name("BINS")
      ->capture_default_str();
  verb->add_flag("--rgb", options->rgb,
                 ".bsdf: no spectra, as the RGB variants of Mitsuba 3 need it; pbrt-v4 and its "
                 "spectral variants need them");
  add_cell_policies(*verb, options->policies);
  verb->footer(
      "IN OUT, or IN ... FOLDER, or --scene: of several materials, what fails is named at the end, and the others are "
      "written.\n"
      "MERL to MERL, RGL to RGL, and MBSDF to MBSDF without --grid, keep the values as they are stored.\n"
      "Anything else is sampled at the cell centres of OUT. A fit.json is a table of MERL's cells\n"
      "for a stack, and the model itself at the cell centres of a table.\n\n"
      "Examples:\n"
      "  gonio convert chrome.binary chrome.exr\n"
      "  gonio convert satin.bsdf small.exr --max-variance 0.01\n"
      "  gonio convert satin.bsdf near.exr --budget 128KiB\n"
      "  gonio convert satin.bsdf satin.exr --comment 'measured at EPFL RGL, CC0'\n"
      "  gonio convert paper.bsdf paper --max-variance 0.01 --front front.json\n"
      "  gonio convert satin.bsdf satin.exr --interpolation displacement --grid 16x16\n"
      "  gonio convert satin.bsdf satin.binary\n"
      "  gonio convert satin.bsdf satin.mbsdf --grid 45x90\n"
      "  gonio convert chrome.binary chrome.bsdf\n"
      "  gonio convert measured/*.bsdf stacks/\n"
      "  gonio convert fit.json fit.exr\n"
      "  gonio convert --scene scene.json --budget 8MiB -o stacks");
  verb->callback([options, verb] { convert(*verb, *options); });
}

}  // namespace gonio
