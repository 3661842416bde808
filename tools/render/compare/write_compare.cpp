#include "tools/render/compare/write_compare.h"

#include <cmath>
#include <cstdio>
#include <ostream>

#include <gonio/mapping/base/atomic_file.h>

#include "tools/page/base64.h"
#include "tools/page/write_page.h"
#include "tools/render/image/difference.h"
#include "tools/render/image/tone_map.h"
#include "tools/report/measure/measure_material.h"

namespace gonio {
namespace {

using nlohmann::json;

const ConvergencePoint& at_samples(const CompareRun& run, int samples) {
  for (const ConvergencePoint& p : run.convergence)
    if (p.samples == samples) return p;
  return run.convergence.back();
}

json ratio(double error, double of_default) { return of_default > 0 ? json(error / of_default) : json(); }

std::string file_name(const CompareRun& run) {
  return std::string(to_string(run.method)) + "_" + to_string(run.strategy);
}

std::string number(const json& x) {
  if (x.is_null()) return "–";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x.get<double>());
  return text;
}

void write_markdown(std::ostream& out, const json& j) {
  out << "# Sampling methods in a path tracer: " << j["scene"].get<std::string>() << "\n\ngonio " GONIO_VERSION ", "
      << j["machine"]["cpu"].get<std::string>() << ". " << j["width"] << " × " << j["height"] << " pixels, of which "
      << j["pixels"] << " show the material: errors are over these. Reference: " << j["reference"]["samples"]
      << " samples a pixel, its own relMSE " << number(j["reference"]["relmse"])
      << ", which is subtracted. After ±: the standard error, from the spread over the pixels; where fireflies make it "
         "large, a factor says little. Cost: relMSE at equal samples times the time of a sample. Processor seconds of "
         "a render: "
      << number(j["seconds"]) << ".\n\n";
  for (const char* strategy : {"mis", "bsdf"}) {
    out << "## " << (std::string(strategy) == "mis" ? "With multiple importance sampling" : "Material sampling alone")
        << "\n\n"
        << "| method | samples | relMSE at equal time | over default's | relMSE at " << j["equal_samples"]
        << " samples | over default's | µs a sample | cost over default's |\n|---|---|---|---|---|---|---|---|\n";
    for (const json& run : j["runs"])
      if (run["strategy"] == strategy)
        out << "| " << run["method"].get<std::string>() << " | " << run["samples"] << " | " << number(run["relmse"])
            << " ± " << number(run["standard_error"]) << " | " << number(run["ratio"]) << " | "
            << number(run["relmse_at_equal_samples"]) << " ± " << number(run["standard_error_at_equal_samples"])
            << " | " << number(run["ratio_at_equal_samples"]) << " | " << number(run["microseconds_per_sample"])
            << " | " << number(run["cost_ratio"]) << " |\n";
    out << '\n';
  }
  out << "Pictures: `METHOD_STRATEGY.png`, and `METHOD_STRATEGY_difference.png`, red where it is too bright and blue "
         "where it is too dark, full colour at half of the reference.\n";
}

}  // namespace

json to_json(const Comparison& c, const std::string& scene, const CompareOptions& options) {
  const Machine machine = this_machine();
  json j{{"gonio_version", GONIO_VERSION},
         {"machine", {{"cpu", machine.cpu}, {"compiler", machine.compiler}, {"threads", machine.threads}}},
         {"scene", scene},
         {"width", c.reference.width},
         {"height", c.reference.height},
         {"pixels", c.pixels},
         {"seconds", options.seconds},
         {"seed", options.render.seed},
         {"equal_samples", c.equal_samples},
         {"reference",
          {{"samples", c.reference_samples}, {"seconds", options.reference_seconds}, {"relmse", c.reference_relmse}}},
         {"runs", json::array()}};
  for (const CompareRun& run : c.runs) {
    const CompareRun* base = nullptr;  // the default with the same strategy
    for (const CompareRun& other : c.runs)
      if (other.method == SamplingMethod::automatic && other.strategy == run.strategy) base = &other;
    const ConvergencePoint &last = run.convergence.back(), &equal = at_samples(run, c.equal_samples);
    const auto cost = [&](const CompareRun& of) {
      return at_samples(of, c.equal_samples).relmse * of.convergence.back().seconds / of.convergence.back().samples;
    };
    json curve = json::array();
    for (const ConvergencePoint& p : run.convergence)
      curve.push_back(
          {{"samples", p.samples}, {"seconds", p.seconds}, {"relmse", p.relmse}, {"standard_error", p.standard_error}});
    const double pixels = static_cast<double>(c.reference.width) * c.reference.height;
    j["runs"].push_back(
        {{"method", to_string(run.method)},
         {"strategy", to_string(run.strategy)},
         {"samples", last.samples},
         {"seconds", last.seconds},
         {"microseconds_per_sample", 1e6 * last.seconds / (last.samples * pixels)},
         {"build_seconds", run.build_seconds},
         {"relmse", last.relmse},
         {"standard_error", last.standard_error},
         {"ratio", base ? ratio(last.relmse, base->convergence.back().relmse) : json()},
         {"relmse_at_equal_samples", equal.relmse},
         {"standard_error_at_equal_samples", equal.standard_error},
         {"ratio_at_equal_samples", base ? ratio(equal.relmse, at_samples(*base, c.equal_samples).relmse) : json()},
         {"cost_ratio", base ? ratio(cost(run), cost(*base)) : json()},
         {"convergence", curve}});
  }
  return j;
}

void write_comparison(const std::filesystem::path& folder, const Comparison& c, const std::string& scene,
                      const CompareOptions& options) {
  const json j = to_json(c, scene, options);
  json page = j;
  const auto picture = [&](const std::string& name, const std::string& png) {
    write_stream_atomically(folder / (name + ".png"), [&](std::ostream& out) { out << png; });
    return "data:image/png;base64," + base64(png);
  };
  page["reference"]["picture"] = picture("reference", tone_mapped_png(c.reference));
  for (std::size_t k = 0; k < c.runs.size(); ++k) {
    const std::string name = file_name(c.runs[k]);
    page["runs"][k]["picture"] = picture(name, tone_mapped_png(c.runs[k].image));
    page["runs"][k]["difference"] = picture(name + "_difference", difference_png(c.runs[k].image, c.reference));
  }
  write_stream_atomically(folder / "compare.json", [&](std::ostream& out) {
    out << j.dump(1, ' ', false, json::error_handler_t::replace) << '\n';
  });
  write_stream_atomically(folder / "compare.md", [&](std::ostream& out) { write_markdown(out, j); });
  write_stream_atomically(folder / "compare.html", [&](std::ostream& out) { write_compare_page(out, page); });
}

}  // namespace gonio
