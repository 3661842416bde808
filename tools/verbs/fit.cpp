#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <gonio/brdf/exr/stack_file.h>
#include <gonio/fitting/fit/fit_json.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/failures.h"
#include "tools/cli/input.h"
#include "tools/cli/number.h"
#include "tools/cli/options.h"
#include "tools/cli/progress.h"
#include "tools/cli/written.h"
#include "tools/measure/table_fits.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

struct Options {
  std::vector<std::string> inputs;
  std::string out, table, model = "auto";
  double cutoff_degrees = default_grazing_cutoff * 180 / pi<double>;
  bool samples_count_alike = false;
  FitOptions fit;
  CellPolicies policies;
};

const char* to_text(Compression compression) noexcept {
  switch (compression) {
    case Compression::none:
      return "none";
    case Compression::log:
      return "log";
    default:
      return "cube-root";
  }
}

BrdfTable load(const Options& options, const std::string& input) {
  if (is_exr(input)) {
    throw Error(input + ": format: found a stack file, expected a table (MERL, RGL or MBSDF)");
  }
  return load_input(input, options.policies);
}

TableFits fit_file(const Options& options, const std::string& input) {
  const ProgressLine progress("fitting " + input);
  const BrdfTable table = load(options, input);
  const LobeModel form = parse_model(options.model == "auto" ? default_fit_form : options.model);
  try {
    return fit_table(table, form, options.fit);
  } catch (const Error& error) {
    throw Error(input + ": " + error.what());
  }
}

void check_output(const std::string& output, const std::vector<std::string>& inputs) {
  check_not_input(output, {inputs.begin(), inputs.end()});
  check_writable(output);
}

/// A dash where nothing was measured.
std::string error_text(double error) { return std::isnan(error) ? "-" : number(error); }

void print_errors(const char* label, double FitErrors::*measure, const char* unit, const FitErrorReport& errors) {
  std::printf("  %-22s %-11s %-11s %s\n", label, error_text(errors.inside.*measure).c_str(),
              error_text(errors.beyond.*measure).c_str(), unit);
}

void print_fit(const Options& options, const StageFit& stage, double seconds) {
  const FitSummary& s = stage.fit.summary;
  std::printf("%s\n", describe(stage.fit.model).c_str());
  std::printf("%s after %d iterations, cost %.6g from %.6g, %d pairs of directions, %.1f s\n", to_string(s.termination),
              s.iterations, s.cost, s.initial_cost, s.samples, seconds);
  std::printf("%d of %zu starts within 1 %% of that cost\n", s.agreeing_starts, s.costs.size());
  std::printf("  %-22s %-11s %s\n", "parameter", "value", "range over those starts");
  for (const ParameterSpread& p : s.parameters) {
    std::printf("  %-22s %-11.5g %.5g to %.5g\n", p.name.c_str(), p.value, p.min, p.max);
  }
  std::printf("  %-22s %-11s %s\n", "error", ("to " + number(options.cutoff_degrees) + " deg").c_str(), "beyond");
  const FitErrorReport& e = stage.errors;
  print_errors("cosine-weighted RMS", &FitErrors::cosine_rms, "1/sr", e);
  print_errors("log RMS", &FitErrors::log_rms, "natural logarithm", e);
  print_errors("relative L1", &FitErrors::relative_l1, "", e);
  print_errors("albedo", &FitErrors::albedo, "", e);
  print_errors("sphere", &FitErrors::delta_e, "CIEDE2000", e);
}

void fit_one(const Options& options) {
  if (!options.out.empty()) {
    checked_extension(options.out, {".json"});
    check_output(options.out, options.inputs);
  }
  const TableFits fits = fit_file(options, options.inputs.front());
  std::size_t chosen = fits.stages.size() - 1;
  if (options.model == "auto") {
    chosen = enough_lobes(fits);
    std::printf("relative L1 to %s degrees:", number(options.cutoff_degrees).c_str());
    for (std::size_t k = 0; k < fits.stages.size(); ++k) {
      std::printf("%s %zu lobe%s %.3g", k > 0 ? "," : "", k + 1, k > 0 ? "s" : "",
                  fits.stages[k].errors.inside.relative_l1);
    }
    const double error = fits.stages[chosen].errors.inside.relative_l1;
    std::printf("; chosen: %zu, the fewest within %.0f %% of the best", chosen + 1, 100 * (enough_factor - 1));
    if (chosen + 1 < fits.stages.size()) {
      double best = error;
      for (const StageFit& s : fits.stages) best = std::min(best, s.errors.inside.relative_l1);
      std::printf(" (more lobes lower the error by %.1f %% at most)", 100 * (1 - best / error));
    } else {
      std::printf(" (one lobe less has an error %.0f %% higher)",
                  100 * (fits.stages[chosen - 1].errors.inside.relative_l1 / error - 1));
    }
    std::printf("\n");
  }
  const StageFit& stage = fits.stages[chosen];
  print_fit(options, stage, fits.seconds);
  if (options.out.empty()) return;
  const std::string json = to_json(stage.fit, stage.errors);
  write_stream_atomically(options.out, [&](std::ostream& out) { out << json; });
  print_written(options.out);
}

void write_rows(std::ostream& out, const TableFits& fits) {
  for (std::size_t k = 0; k < fits.stages.size(); ++k) {
    const auto& [fit, errors] = fits.stages[k];
    out << "| " << fit.model.name << " | " << fit.model.specular_count();
    for (const FitErrors& e : {errors.inside, errors.beyond}) {
      for (const double x : {e.cosine_rms, e.log_rms, e.relative_l1, e.albedo, e.delta_e})
        out << " | " << error_text(x);
    }
    out << " | " << number(fit.summary.cost, 4) << " | " << to_string(fit.summary.termination) << " | ";
    if (k + 1 == fits.stages.size()) out << number(fits.seconds, 2);
    out << " |\n";
  }
}

/// Those that load: a fit takes long, and is not begun before all are known.
std::vector<std::string> usable_inputs(const Options& options, Failures& failures) {
  std::vector<std::string> usable;
  for (const std::string& input : options.inputs) {
    const ProgressLine progress("reading " + input);
    if (failures.survives([&] { load(options, input); })) usable.push_back(input);
  }
  return usable;
}

void fit_to_table(const Options& options) {
  checked_extension(options.table, {".md"});
  check_output(options.table, options.inputs);
  Failures failures;
  const std::vector<std::string> inputs = usable_inputs(options, failures);
  std::ostringstream text;
  text << "# Errors of fitted lobes\n\nModel `" << (options.model == "auto" ? default_fit_form : options.model)
       << "` and its stages with fewer specular lobes; cut-off " << number(options.cutoff_degrees)
       << " degrees, compression " << to_text(options.fit.compression) << ", channels "
       << (options.fit.separate_channels ? "separate" : "shared")
       << ". Cosine-weighted RMS in 1/sr, log RMS as natural logarithm, relative L1 and albedo "
          "without unit, ΔE is CIEDE2000 of a lit sphere; each inside the cut-off, then beyond it, and of what was "
          "measured alone: a dash where nothing was. "
          "The cost is what the fit minimises: more lobes never raise it, while the errors, which weigh differently, "
          "may rise a little. Seconds are of all stages of a material together."
          "\n\n| material | lobes | RMS | log RMS | L1 | albedo | ΔE | RMS beyond | log RMS beyond "
          "| L1 beyond | albedo beyond | ΔE beyond | cost | termination | s |\n|";
  for (int k = 0; k < 15; ++k) text << "---|";
  text << '\n';
  std::size_t fitted = 0;
  for (const std::string& input : inputs) {
    TableFits fits;
    if (!failures.survives([&] { fits = fit_file(options, input); })) continue;
    ++fitted;
    write_rows(text, fits);
    std::printf("%s: relative L1", input.c_str());
    for (const StageFit& s : fits.stages) std::printf(" %.3g", s.errors.inside.relative_l1);
    std::printf(", %.1f s\n", fits.seconds);
    std::fflush(stdout);
  }
  if (fitted == 0) failures.throw_any(options.inputs.size());
  write_stream_atomically(options.table, [&](std::ostream& out) { out << text.str(); });
  print_written(options.table);
  failures.throw_any(options.inputs.size());
}

void fit_verb(Options& options) {
  if (!(options.cutoff_degrees > 0 && options.cutoff_degrees <= 90)) {
    throw Error("--cutoff: found " + number(options.cutoff_degrees) + ", expected more than 0, up to 90");
  }
  options.fit.grazing_cutoff = options.cutoff_degrees * pi<double> / 180;
  options.fit.solid_angle_weights = !options.samples_count_alike;
  if (!options.table.empty()) {
    if (!options.out.empty()) throw Error("-o: found one, expected none: --table keeps errors only");
    fit_to_table(options);
    return;
  }
  if (options.inputs.size() > 1) {
    throw Error("IN: found " + std::to_string(options.inputs.size()) + ", expected one, or --table FILE.md");
  }
  fit_one(options);
}

/// An option with a fixed set of words.
template <class T>
CLI::Option* add_choice(CLI::App& verb, const std::string& name, const std::vector<std::pair<std::string, T>>& choices,
                        T& value, const std::string& help) {
  std::string type, initial;
  std::vector<std::string> words;
  for (const auto& [word, meaning] : choices) {
    type += (type.empty() ? "" : "|") + word;
    words.push_back(word);
    if (meaning == value) initial = word;
  }
  return verb
      .add_option_function<std::string>(
          name,
          [=, &value](const std::string& text) {
            for (const auto& [word, meaning] : choices) {
              if (text != word) continue;
              value = meaning;
              return;
            }
            throw CLI::ValidationError(name, "found '" + text + "', expected " + one_of(words, text));
          },
          help)
      ->type_name(type)
      ->default_str(initial);
}

}  // namespace

void add_fit(CLI::App& app) {
  auto options = std::make_shared<Options>();
  FitOptions& fit = options->fit;
  CLI::App* verb = app.add_subcommand("fit", "Analytic lobes that come closest to a table");
  verb->add_option("IN", options->inputs, "MERL, RGL or MBSDF table, or fit.json")->required();
  verb->add_option("-o,--output", options->out, "File to write: the model as JSON")->type_name("FIT.json");
  verb->add_option("--table", options->table, "File to write instead: the errors of all stages of all INs, as Markdown")
      ->type_name("FILE.md");
  verb->add_option("--model", options->model,
                   "Lobes joined by +, see gonio synth --list; 'auto' is one to three GGX over "
                   "Lambert, the fewest that are enough")
      ->capture_default_str();
  add_choice<bool>(*verb, "--channels", {{"shared", false}, {"separate", true}}, fit.separate_channels,
                   "Shapes per channel, or one for the three");
  verb->add_option("--cutoff", options->cutoff_degrees,
                   "Pairs with a direction beyond this angle are left out of the fit")
      ->type_name("DEGREES")
      ->capture_default_str();
  add_choice<Compression>(
      *verb, "--compression",
      {{"none", Compression::none}, {"cube-root", Compression::cube_root}, {"log", Compression::log}}, fit.compression,
      "What is compared: f_r cos, its cube root or logarithm");
  add_choice<bool>(*verb, "--weights", {{"solid-angle", false}, {"samples", true}}, options->samples_count_alike,
                   "What a pair counts: its solid angles, or all alike");
  verb->add_option("--robust", fit.robust_width,
                   "Width of a Huber loss in compressed units, 0 is least squares; 0.05 suits noise")
      ->capture_default_str();
  verb->add_option("--starts", fit.starts, "Random starts for each number of lobes")->capture_default_str();
  verb->add_option("--seed", fit.seed, "Seed of the starts")->capture_default_str();
  verb->add_option("--iterations", fit.max_iterations, "At most this many for each start")->capture_default_str();
  add_cell_policies(*verb, options->policies);
  verb->footer(
      "Cells that a reader filled were not measured: they are neither fitted nor compared.\n"
      "The JSON is an input of info, validate, convert, report, synth, render and compare, and\n"
      "holds snippets for pbrt-v4 and Mitsuba 3 where the model exists there.\n\n"
      "Examples:\n"
      "  gonio fit chrome.binary -o chrome.json\n"
      "  gonio fit satin.bsdf --model ggx+lambert --channels separate -o fit.json\n"
      "  gonio fit measured/*.bsdf --table errors.md");
  verb->callback([options] { fit_verb(*options); });
}

}  // namespace gonio
