#include "tools/report/write_report.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <ostream>

#include <gonio/fitting/fit/fit.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/charts/concentric.h>

#include "tools/cli/number.h"
#include "tools/measure/timing.h"
#include "tools/page/write_page.h"
#include "tools/report/compare_lobes.h"
#include "tools/report/grid_figure.h"
#include "tools/report/verdict.h"
#include "tools/stability/summary.h"

namespace gonio {
namespace {

double degrees(double radians) { return radians * 180 / pi<double>; }

nlohmann::json rgb(const glm::dvec3& v) { return {v.r, v.g, v.b}; }

nlohmann::json to_json(const CallTimes& one, const std::optional<CallTimes>& batch) {
  nlohmann::json ns = {{"sample", one.sample}, {"pdf", one.pdf}, {"eval", one.eval}};
  if (batch) ns["sample_batch"] = batch->sample, ns["pdf_batch"] = batch->pdf, ns["eval_batch"] = batch->eval;
  return ns;
}

nlohmann::json to_json(const proof::Quality& q) {
  return {{"theta_i_deg", std::round(degrees(q.theta_i) * 1e6) / 1e6},
          {"relvar", q.relvar},
          {"max_weight", q.max_weight},
          {"max_direction_weight", q.max_direction_weight},
          {"invalid_fraction", q.invalid_fraction},
          {"pdf_integral", q.pdf_integral},
          {"albedo", rgb(q.albedo)},
          {"albedo_table", rgb(q.albedo_table)},
          {"chi2_p", q.chi2.p}};
}

std::string kib(std::size_t bytes) { return number(static_cast<double>(bytes) / 1024, 3) + " KiB"; }

/// A picture of a material: its name, as far as a file may have it, with an ending.
std::string picture_file(const MaterialReport& material, const char* ending) {
  std::string file = material.name;
  for (char& c : file) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && !std::isalnum(byte) && c != '-' && c != '.') c = '_';
  }
  return file + ending;
}
std::string grid_file(const MaterialReport& material) { return picture_file(material, ".svg"); }
std::string weights_file(const MaterialReport& material) { return picture_file(material, "-weights.svg"); }

bool share_files(const MaterialReport& a, const MaterialReport& b) {
  return grid_file(a) == grid_file(b) || grid_file(a) == weights_file(b) || weights_file(a) == grid_file(b);
}

/// The most efficient method of each material.
void write_overview(std::ostream& out, const Report& report) {
  if (report.materials.empty()) return;
  out << "\nEfficiency is 1 / (ns of a sample × (mean relvar from 2° to 70° + 0.001)).\n\n"
         "| material | most efficient | sample ns | mean relvar | efficiency | worst weight | in memory "
         "|\n|---|---|---|---|---|---|---|\n";
  for (const MaterialReport& material : report.materials) {
    const MethodReport* best = best_method(material);
    if (!best) continue;
    double worst = 0;
    for (const auto& q : best->angles) worst = std::max(worst, q.max_weight);
    out << "| " << material.name << " | " << title(*best) << " | " << number(best->ns.sample) << " | "
        << number(mean_relvar(*best), 2) << " | " << number(efficiency(*best)) << " | " << number(worst) << " | "
        << kib(best->bytes) << " |\n";
  }
}

void write_markdown(std::ostream& out, const Report& report) {
  out << "# Sampling quality\n\ngonio " GONIO_VERSION ", " << report.machine.cpu << ", " << report.machine.compiler
      << ", " << report.machine.threads << " threads. Made by\n\n    " << report.command << "\n\n"
      << "`relvar` is Var[w] / E[w]^2 of the luminance weight w = f_r cos(theta_o) / pdf on a jittered 256 x 256 grid: "
         "the "
         "variance of a white-furnace estimate, 0 is perfect, and the number of samples for a given noise is in "
         "proportion to it. "
         "Times are nanoseconds a call on one thread. A chi-square p below "
      << number(report_significance(report), 2)
      << " (0.01 for the whole report, Sidak) says that draws do not follow the pdf.\n";
  write_overview(out, report);
  for (const MaterialReport& material : report.materials) {
    out << "\n## " << material.name << "\n\n"
        << material.format << ", " << kib(material.source_bytes) << " on disk, `" << material.source << "`, SHA-256 `"
        << material.sha256 << "`\n\n**" << verdict(material) << "**\n\n![grid](" << grid_file(material) << ")\n\n"
        << "| method | chart | in memory | build s | sample ns | pdf ns | eval ns | in batches: sample ns | pdf ns | "
           "eval ns | efficiency |";
    for (const double angle : report_angles) out << " relvar " << angle << "° |";
    out << "\n|---|---|---|---|---|---|---|---|---|---|---|";
    for (std::size_t k = 0; k < std::size(report_angles); ++k) out << "---|";
    out << '\n';
    for (const MethodReport& m : material.methods) {
      out << "| " << m.id << " | " << m.chart << " | " << kib(m.bytes) << " | " << number(m.build_seconds, 2) << " | "
          << number(m.ns.sample) << " | " << number(m.ns.pdf) << " | " << number(m.ns.eval) << " | ";
      if (m.ns_batch)
        out << number(m.ns_batch->sample) << " | " << number(m.ns_batch->pdf) << " | " << number(m.ns_batch->eval);
      else
        out << "- | - | -";
      out << " | " << number(efficiency(m)) << " |";
      for (const auto& q : m.angles) out << ' ' << number(q.relvar, 2) << " |";
      out << '\n';
    }
    out << "\nAt " << coherence_angle
        << "°: stretch of small cells of the square, tears and folds, and the exponents with which the error falls "
           "with the number of Sobol' and of random points.\n\n"
           "| method | stretch, median | stretch, 99 % | tears | Sobol' slope | random slope "
           "|\n|---|---|---|---|---|---|\n";
    for (const MethodReport& m : material.methods)
      out << "| " << m.id << " | " << number(m.coherence.stretch_p50) << " | " << number(m.coherence.stretch_p99)
          << " | " << m.coherence.tears + m.coherence.folds << " | " << number(m.convergence.qmc_slope, 2) << " | "
          << number(m.convergence.mc_slope, 2) << " |\n";
    if (!material.front.empty()) {
      out << "\nWhat memory buys (lobes draw for the table, compact BSDFs need none):\n\n| form | in memory | ns | "
             "relvar | evaluation error | kept |\n|---|---|---|---|---|---|\n";
      for (const nlohmann::json& point : material.front) {
        out << "| " << point["id"].get<std::string>() << " | " << kib(point["bytes"]);
        for (const char* key : {"ns", "relvar", "eval_error"}) out << " | " << number(point[key]);
        out << " | " << (point["chosen"] == true ? "yes" : "") << " |\n";
      }
    }
    write_lobes(out, material);
    out << "\n| method | θi | max weight of draws | of directions | invalid | pdf integral | albedo sampled | albedo "
           "table | χ² p |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const MethodReport& m : material.methods) {
      for (const auto& q : m.angles) {
        out << "| " << m.id << " | " << number(degrees(q.theta_i)) << "° | " << number(q.max_weight) << " | "
            << number(q.max_direction_weight) << " | " << number(q.invalid_fraction) << " | "
            << number(q.pdf_integral, 5);
        for (const auto& a : {q.albedo, q.albedo_table})
          out << " | " << number(a.r, 4) << ' ' << number(a.g, 4) << ' ' << number(a.b, 4);
        out << " | " << number(q.chi2.p, 2) << " |\n";
      }
    }
  }
  for (const LightReport& light : report.lights) {
    out << "\n## " << light.name << "\n\n"
        << light.format << ", `" << light.source << "`, SHA-256 `" << light.sha256 << "`, " << number(light.flux, 6)
        << " lm. `relvar` is that of emission: w is intensity / pdf.\n\n| method | flux, lm | relvar | ns a draw "
           "|\n|---|---|---|---|\n";
    for (const EmissionQuality& q : light.methods)
      out << "| " << q.method << " | " << number(q.flux, 6) << " | " << number(q.relvar, 2) << " | "
          << number(q.nanoseconds_per_draw) << " |\n";
  }
  if (!report.stability.is_null()) {
    out << "\n## Where methods fail\n\nTextbook formulas in float beside the library's own (`gonio-`), judged in long "
           "double.\n\n";
    write_stability_summary(out, report.stability);
  }
}

}  // namespace

double report_significance(const Report& report) {
  int tests = 0;
  for (const auto& material : report.materials)
    for (const auto& method : material.methods) tests += static_cast<int>(method.angles.size());
  return tests > 0 ? proof::sidak(0.01, tests) : 0.01;
}

void add_material(Report& report, MaterialReport material) {
  const std::string name = material.name;
  const auto taken = [&](const MaterialReport& other) { return share_files(material, other); };
  for (int k = 2; std::any_of(report.materials.begin(), report.materials.end(), taken); ++k)
    material.name = name + "-" + std::to_string(k);
  report.materials.push_back(std::move(material));
}

nlohmann::json to_json(const Report& report) {
  nlohmann::json materials = nlohmann::json::array();
  for (const MaterialReport& material : report.materials) {
    nlohmann::json methods = nlohmann::json::array();
    for (const MethodReport& m : material.methods) {
      nlohmann::json angles = nlohmann::json::array();
      for (const auto& q : m.angles) angles.push_back(to_json(q));
      methods.push_back({{"id", m.id},
                         {"chart", m.chart},
                         {"params", m.params},
                         {"bytes", m.bytes},
                         {"build_seconds", m.build_seconds},
                         {"ns", to_json(m.ns, m.ns_batch)},
                         {"angles", std::move(angles)},
                         {"coherence",
                          {{"stretch_p50", m.coherence.stretch_p50},
                           {"stretch_p99", m.coherence.stretch_p99},
                           {"tears", m.coherence.tears + m.coherence.folds}}},
                         {"qmc_slope", m.convergence.qmc_slope},
                         {"mc_slope", m.convergence.mc_slope},
                         {"qmc_error", m.convergence.qmc_error},
                         {"mc_error", m.convergence.mc_error},
                         {"mean_relvar", mean_relvar(m)},
                         {"efficiency", efficiency(m)},
                         {"curves", m.curves}});
    }
    materials.push_back({{"name", material.name},
                         {"source", material.source},
                         {"format", material.format},
                         {"source_bytes", material.source_bytes},
                         {"sha256", material.sha256},
                         {"methods", std::move(methods)},
                         {"fits", material.fits},
                         {"curves", material.curves},
                         {"verdict", verdict(material)}});
    if (!material.front.empty()) materials.back()["front"] = material.front;
    if (const auto comparison = compare_lobes(material)) materials.back()["lobes_against_stack"] = to_json(*comparison);
  }
  nlohmann::json lights = nlohmann::json::array();
  for (const LightReport& light : report.lights) {
    nlohmann::json methods = nlohmann::json::array();
    for (const EmissionQuality& q : light.methods)
      methods.push_back(
          {{"id", q.id}, {"flux", q.flux}, {"relvar", q.relvar}, {"ns", {{"sample", q.nanoseconds_per_draw}}}});
    lights.push_back({{"name", light.name},
                      {"source", light.source},
                      {"format", light.format},
                      {"source_bytes", light.source_bytes},
                      {"sha256", light.sha256},
                      {"flux", light.flux},
                      {"methods", std::move(methods)}});
  }
  nlohmann::json json = {
      {"gonio_version", GONIO_VERSION},
      {"command", report.command},
      {"machine",
       {{"cpu", report.machine.cpu}, {"compiler", report.machine.compiler}, {"threads", report.machine.threads}}},
      {"seeds", {{"measures", proof::MeasureOptions().seed}, {"times", timing_seed}, {"fits", FitOptions().seed}}},
      {"materials", std::move(materials)},
      {"lights", std::move(lights)}};
  if (!report.stability.is_null()) json["stability"] = report.stability;
  return json;
}

void write_report(const std::filesystem::path& directory, const Report& report) {
  for (const MaterialReport& material : report.materials) {
    if (!material.weights.empty())
      write_weights_figure(directory / weights_file(material), material.name, material.weights);
    if (material.stack) write_grid_figure(directory / grid_file(material), material.name, *material.stack);
  }
  const nlohmann::json json = to_json(report);
  write_stream_atomically(directory / "report.json", [&](std::ostream& out) {
    out << json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  });
  write_stream_atomically(directory / "report.html", [&](std::ostream& out) { write_page(out, json); });
  write_stream_atomically(directory / "report.md", [&](std::ostream& out) { write_markdown(out, report); });
}

void print_summary(std::ostream& out, const Report& report) {
  const auto cell = [&](const std::string& text, int width) -> std::ostream& {
    return out << std::setw(width) << text;
  };
  out << std::left << std::setw(28) << "material" << std::setw(20) << "method" << std::setw(10) << "chart"
      << std::right;
  for (const char* head : {"KiB memory", "sample ns", "pdf ns"}) cell(head, 11);
  for (const double angle : report_angles) cell("rv " + number(angle) + "°", 10);  // the degree sign is two bytes
  out << '\n';
  for (const MaterialReport& material : report.materials) {
    for (const MethodReport& m : material.methods) {
      out << std::left << std::setw(28) << material.name << std::setw(20) << m.id << std::setw(10) << m.chart
          << std::right;
      cell(number(static_cast<double>(m.bytes) / 1024), 11);
      cell(number(m.ns.sample), 11);
      cell(number(m.ns.pdf), 11);
      for (const auto& q : m.angles) cell(number(q.relvar, 2), 9);
      out << '\n';
    }
  }
  for (const LightReport& light : report.lights)
    for (const EmissionQuality& q : light.methods)
      out << light.name << ": " << q.method << ": relvar " << number(q.relvar, 2) << ", "
          << number(q.nanoseconds_per_draw) << " ns a draw\n";
}

}  // namespace gonio
