#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/options.h"
#include "tools/cli/progress.h"
#include "tools/cli/written.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

struct Options {
  bool list = false;
  std::string model, out;
  double measured_to_degrees = 90;
  SynthOptions synth;
};

void print_parameter(const Parameter& parameter) {
  std::printf("    %-10s %-8g %g to %g", parameter.name, parameter.initial, parameter.min, parameter.max);
  const std::string unit = parameter.unit;
  std::printf("%s\n", unit == "1" ? "" : (" (" + unit + ")").c_str());
}

void print_models() {
  std::printf("Lobes, with parameters, defaults and ranges:\n");
  for (const LobeKind kind : lobe_kinds()) {
    const LobeInfo& info = lobe_info(kind);
    std::printf("  %s: %s\n", info.id, info.source);
    for (const Parameter& parameter : info.shape) print_parameter(parameter);
    for (const Parameter& parameter : color_parameters(kind, Fresnel::schlick)) print_parameter(parameter);
  }
  std::printf("A specular lobe with one of these is a conductor, and has no F0 and F90:\n");
  for (const Parameter& parameter : color_parameters(LobeKind::ggx, Fresnel::conductor)) print_parameter(parameter);
  std::printf("default is %s\n", describe(parse_model("default")).c_str());
}

/// A description, or the name of a model file.
LobeModel model_of(const std::string& text) {
  std::error_code none;
  const bool file = std::filesystem::path(text).extension() == ".json" || std::filesystem::is_regular_file(text, none);
  return file ? load_model(text) : parse_model(text);
}

/// The model itself.
void write_model(const CLI::App& verb, const Options& options) {
  for (const char* option : {"--noise", "--seed", "--measured-to"})
    if (verb.count(option) > 0) throw Error(std::string(option) + ": found one, expected none: a model has no cells");
  const std::string text = to_json(model_of(options.model));
  write_stream_atomically(options.out, [&](std::ostream& stream) { stream << text; });
  print_written(options.out);
}

void synth(const CLI::App& verb, Options& options) {
  if (options.list) {
    print_models();
    return;
  }
  if (options.model.empty()) throw Error("MODEL: found none, expected one; see gonio synth --list");
  if (options.out.empty()) throw Error("-o: found no output file, expected a .binary, .mbsdf or .json file");
  const std::string extension = checked_extension(options.out, {".binary", ".mbsdf", ".json"});
  check_not_input(options.out, {options.model});
  if (extension == ".json") {
    write_model(verb, options);
    return;
  }
  const double sigma = options.synth.noise_sigma, limit = options.measured_to_degrees;
  if (!(sigma >= 0 && std::isfinite(sigma))) {
    throw Error("--noise: found " + std::to_string(sigma) + ", expected a number from 0");
  }
  if (!(limit > 0 && limit <= 90)) {
    throw Error("--measured-to: found " + std::to_string(limit) + ", expected more than 0, up to 90");
  }
  options.synth.measured_to = limit * pi<double> / 180;
  const LobeModel model = model_of(options.model);
  const ProgressLine progress("computing " + options.out);
  if (extension == ".binary") {
    write_merl(options.out, synthesize_merl(model, options.synth));
  } else {
    write_mbsdf(options.out, synthesize_mbsdf(model, 90, 180, options.synth));
  }
  print_written(options.out);
}

}  // namespace

void add_synth(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("synth", "A table computed from an analytic model, or the model as a file");
  verb->add_option("MODEL", options->model,
                   "'default', lobes joined by + with their parameters (see --list), or a fit.json");
  verb->add_option("-o,--output", options->out,
                   "File to write: MERL (.binary), MBSDF (.mbsdf), or the model itself (.json)")
      ->type_name("OUT");
  verb->add_flag("--list", options->list, "Lists lobes and parameters");
  verb->add_option("--noise", options->synth.noise_sigma, "Standard deviation of the noise that multiplies each value")
      ->capture_default_str();
  verb->add_option("--seed", options->synth.seed, "Seed of the noise")->capture_default_str();
  verb->add_option("--measured-to", options->measured_to_degrees,
                   "Cells with a direction beyond this angle are marked as not measured")
      ->type_name("DEGREES")
      ->capture_default_str();
  verb->footer(
      "The result is computed, not measured.\n\n"
      "Examples:\n"
      "  gonio synth --list\n"
      "  gonio synth default -o default.binary\n"
      "  gonio synth default -o default.json\n"
      "  gonio synth ggx:alpha=0.1,F0=0.04+lambert:albedo=0.5/0.3/0.1 -o plastic.mbsdf\n"
      "  gonio synth ggx:alpha=0.2,eta=0.2,k=3.9 --noise 0.05 --measured-to 80 -o metal.binary\n"
      "  gonio synth fit.json -o fitted.binary");
  verb->callback([options, verb] { synth(*verb, *options); });
}

}  // namespace gonio
