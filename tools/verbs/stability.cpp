#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <future>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <gonio/brdf/proof/statistics/chi_square.h>
#include <gonio/mapping/base/atomic_file.h>

#include "tools/cli/check_writable.h"
#include "tools/cli/number.h"
#include "tools/cli/progress.h"
#include "tools/stability/figures.h"
#include "tools/stability/measure_row.h"
#include "tools/stability/summary.h"
#include "tools/verbs/verbs.h"

namespace gonio {
namespace {

std::vector<StabilityRow> measure(ProgressLine& line) {
  const std::vector<StabilityInput> inputs = stability_inputs();
  const int rows = static_cast<int>(inputs.size() * variant_names().size());
  std::vector<std::vector<StabilityRow>> results(inputs.size());
  std::atomic<std::size_t> next{0}, done{0};
  const auto work = [&] {
    for (std::size_t k; (k = next++) < inputs.size();) {
      results[k] = measure_input(inputs[k], rows, static_cast<std::uint32_t>(1000 * (k + 1)));
      line.update(static_cast<double>(++done) / static_cast<double>(inputs.size()));
    }
  };
  std::vector<std::future<void>> workers;
  for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k)
    workers.push_back(std::async(std::launch::async, work));
  for (auto& worker : workers) worker.get();
  std::vector<StabilityRow> all;
  for (auto& result : results) all.insert(all.end(), result.begin(), result.end());
  return all;
}

nlohmann::json to_json(const std::vector<StabilityRow>& rows) {
  nlohmann::json json;
  json["chi2_significance"] = proof::sidak(0.01, static_cast<int>(rows.size()));
  for (const StabilityRow& r : rows) {
    nlohmann::json failed = nlohmann::json::array();
    if (r.error_fails) failed.push_back("max_error");
    if (r.bias_fails) failed.push_back("bias");
    if (r.chi2_fails) failed.push_back("chi2_p");
    json["rows"].push_back({{"variant", r.variant},
                            {"input", r.input},
                            {"error_of", r.error_of},
                            {"max_error", r.max_error},
                            {"max_error_bound", r.bound},
                            {"bias", r.bias},
                            {"bias_standard_error", r.standard_error},
                            {"chi2_p", r.chi2_p},
                            {"lost", r.lost},
                            {"fails", r.fails()},
                            {"failed", failed},
                            {"why", r.why}});
  }
  for (const int intervals : {1, 10}) {
    const WorstReading w = worst_reading_error(intervals);
    json["theta_reading"].push_back({{"intervals", intervals}, {"absolute", w.absolute}, {"relative", w.relative}});
  }
  return json;
}

void write_markdown(std::ostream& out, const std::vector<StabilityRow>& rows) {
  out << "# Where methods fail\n\ngonio " GONIO_VERSION
         ". Textbook formulas in float beside the library's own (`gonio-`), judged in long double.\n\n"
         "A variant fails on an input if its largest error exceeds the bound in the table below, if an estimate with "
         "its draws is off by more\n"
         "than 5 standard errors (and 0.03 %, what the quadrature may err), or if the draws can be told from the pdf "
         "claimed: a draw\n"
         "outside the support, or chi-square p below "
      << number(proof::sidak(0.01, static_cast<int>(rows.size())), 2)
      << " (0.01 for all rows together, Sidak). An error of 8.4e+06 ulp is an answer\nwithout a correct "
         "digit.\n\n![chart](stability.svg)\n\n";
  write_stability_summary(out, to_json(rows));
  out << "\n## All rows\n\n| input | variant | error [ulp] | bound | bias | standard error | chi2 p | fails by "
         "|\n|---|---|---|---|---|---|---|---|\n";
  for (const StabilityRow& r : rows) {
    std::string failed;
    if (r.error_fails) failed += "error ";
    if (r.bias_fails) failed += "bias ";
    if (r.chi2_fails) failed += "chi2 ";
    out << "| " << r.input << " | " << r.variant << " | " << number(r.max_error, 2) << " | " << number(r.bound, 2)
        << " | " << number(100 * r.bias, 2) << " % | " << number(100 * r.standard_error, 2) << " % | "
        << number(r.chi2_p, 2) << " | " << failed << "|\n";
  }
  out << "\n## Inputs\n\n";
  for (const StabilityInput& input : stability_inputs()) out << "- " << input.name << ": " << input.reason << "\n";
  out << "\n## The error of reading theta as r\n\n| equal intervals | absolute | relative |\n|---|---|---|\n";
  for (const int intervals : {1, 10}) {
    const WorstReading w = worst_reading_error(intervals);
    out << "| " << intervals << " | " << number(100 * w.absolute, 2) << " % | " << std::setprecision(3)
        << 100 * w.relative << " % |\n";
  }
  out << "\n![Fig. 3](figure3.svg)\n\n![Fig. 6](figure6.svg)\n";
}

void stability(const std::filesystem::path& directory) {
  make_folder(directory, "stability.md");
  std::vector<StabilityRow> rows;
  {
    ProgressLine line("stability");
    rows = measure(line);
  }
  const nlohmann::json json = to_json(rows);
  write_stream_atomically(directory / "stability.json", [&](std::ostream& out) { out << json.dump(1) << '\n'; });
  write_stream_atomically(directory / "stability.md", [&](std::ostream& out) { write_markdown(out, rows); });
  write_chart(directory / "stability.svg", rows);
  write_figure_3(directory / "figure3.svg");
  write_figure_6(directory / "figure6.svg");
  write_stability_summary(std::cout, json);
  std::cout << "written: " << (directory / "stability.md").string()
            << ", stability.json, stability.svg, figure3.svg, figure6.svg\n";
}

}  // namespace

void add_stability(CLI::App& app) {
  auto directory = std::make_shared<std::filesystem::path>();
  CLI::App* verb = app.add_subcommand("stability", "Textbook formulas beside the library's own: which fails where");
  verb->add_option("-o,--output", *directory, "Folder for stability.json, stability.md and the figures")->required();
  verb->footer(
      "Takes about a minute, and gives the same numbers on every run.\n\n"
      "Example:\n"
      "  gonio stability -o stability");
  verb->callback([directory] { stability(*directory); });
}

}  // namespace gonio
