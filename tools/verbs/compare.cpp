#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <gonio/mapping/base/did_you_mean.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/progress.h"
#include "tools/render/compare/compare_runs.h"
#include "tools/render/compare/write_compare.h"
#include "tools/render/load_scene.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

struct Options {
  SceneChoice choice;
  std::vector<std::string> methods;
  std::filesystem::path out;
  std::optional<double> reference_seconds;
  CompareOptions compare;
};

std::vector<SamplingMethod> parse_methods(const std::vector<std::string>& names, const Scene& scene) {
  std::vector<SamplingMethod> available, methods;
  std::vector<std::string> available_names;
  for (const SamplingMethod m : sampling_methods) {
    if (!method_available(scene, m)) continue;
    available.push_back(m);
    available_names.push_back(to_string(m));
  }
  if (names.empty()) return available;
  for (const std::string& name : names) {
    const auto method = parse_sampling_method(name);
    if (!method) throw Error("--methods: found '" + name + "', expected " + one_of(sampling_method_names(), name));
    if (!method_available(scene, *method))
      throw Error("--methods: found " + name + ", which not every material of the scene has, expected " +
                  one_of(available_names, name));
    if (std::find(methods.begin(), methods.end(), *method) == methods.end()) methods.push_back(*method);
  }
  return methods;
}

void compare(Options& options) {
  CompareOptions& o = options.compare;
  if (!(o.seconds > 0 && o.seconds <= 1e9))
    throw Error("--seconds: found " + std::to_string(o.seconds) + ", expected more than 0, to 1e9");
  o.reference_seconds = options.reference_seconds.value_or(16 * o.seconds);
  if (!(o.reference_seconds > 0 && (!options.reference_seconds || o.reference_seconds <= 1e9)))
    throw Error("--reference-seconds: found " + std::to_string(o.reference_seconds) + ", expected more than 0, to 1e9");
  check_render_options(o.render);
  const std::string name =
      std::filesystem::path(options.choice.scene.empty() ? options.choice.material : options.choice.scene)
          .stem()
          .string();
  Comparison comparison;
  {
    ProgressLine line("rendering " + name);
    const Scene scene = options.choice.load();
    o.methods = parse_methods(options.methods, scene);
    check_not_input(options.out, {"compare.html", "compare.md", "compare.json"}, scene.files);
    make_folder(options.out, "compare.html");
    comparison = compare_methods(scene, o, [&](double share) { line.update(share); });
  }
  write_comparison(options.out, comparison, name, o);
  for (const CompareRun& run : comparison.runs)
    std::printf("%-12s %-4s %6d samples  relMSE %.3g\n", to_string(run.method), to_string(run.strategy),
                run.convergence.back().samples, run.convergence.back().relmse);
  std::printf("written: %s, compare.md, compare.json and pictures\n", (options.out / "compare.html").string().c_str());
}

}  // namespace

void add_compare(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand(
      "compare", "What sampling methods are worth in a path tracer, at equal time and at equal samples");
  add_scene_choice(*verb, options->choice);
  options->choice.size = "128x128";
  verb->get_option("--size")->capture_default_str();
  verb->add_option("-o,--output", options->out, "Folder for compare.html, compare.md, compare.json and pictures")
      ->required();
  verb->add_option("--methods", options->methods,
                   "Sampling methods, separated by commas, of " + CLI::detail::join(sampling_method_names(), ", ") +
                       "; without it, all")
      ->delimiter(',');
  verb->add_option("--seconds", options->compare.seconds, "Processor time of each render, all threads together")
      ->capture_default_str();
  verb->add_option("--reference-seconds", options->reference_seconds,
                   "Processor time of the reference; without it, 16 times that of a render");
  add_render_options(*verb, options->compare.render);
  verb->footer(
      "Examples:\n"
      "  gonio compare --material satin.bsdf --seconds 10 -o satin\n"
      "  gonio compare scene.json --methods default,cosine,lobes3 -o car");
  verb->callback([options] { compare(*options); });
}

}  // namespace gonio
