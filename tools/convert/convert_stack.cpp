#include "tools/convert/convert_stack.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/fitting/fit/fit_json.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/check_not_input.h"
#include "tools/cli/check_writable.h"
#include "tools/cli/input.h"
#include "tools/cli/number.h"
#include "tools/cli/progress.h"
#include "tools/cli/written.h"
#include "tools/convert/stack_comments.h"
#include "tools/measure/size_front.h"

namespace gonio {
namespace {

constexpr int colour_side = 16;

/// @param made how it was made: options, and how good it is
StackFile named(const BrdfTable& table, const std::filesystem::path& in, const std::string& made,
                const StackRequest& request) {
  StackFile file;
  file.name = table.info().name;
  file.source = in.filename().string();
  file.comments = stack_comments(file.source, made);
  for (const std::string& comment : request.comments) add_comment(file.comments, comment);
  return file;
}

void by_hand(const std::filesystem::path& in, const std::filesystem::path& out, const StackRequest& request,
             const CellPolicies& policies) {
  const BrdfTable table = load_input(in, policies);
  BsdfOptions options = request.by_hand;
  options.chart = request.chart;
  options.interpolation = request.interpolation.value_or(Interpolation::displacement);
  StackFile file = named(table, in,
                         "sizes by hand, errors not measured: at most " + std::to_string(options.meridians) +
                             " meridians, " + std::to_string(options.parallels) + " parallels, " +
                             std::to_string(options.incident) + " incident angles, " + std::to_string(options.budget) +
                             " bytes; tolerance " + number(*options.max_variance),
                         request);
  {
    ProgressLine progress("building the stack of " + in.string());
    const Stack<float> stack(build_stack(table, options, [&](double share) { progress.update(share); }),
                             options.interpolation);
    file.bsdf = {stack.grid(), options.interpolation,
                 colour_of_table(table, direction_map(stack), stack.theta_i(), colour_side)};
  }
  save_stack(out, file);
  std::printf("chart %s, %s, %zu incident angles\n", to_string(file.bsdf.diagrams.chart),
              to_string(file.bsdf.interpolation), file.bsdf.diagrams.theta_i.size());
  print_written(out);
}

bool missed(const CompactFit& fit, const BsdfOptions& options) {
  return options.max_variance && fit.quality.worst_relvar > *options.max_variance;
}

/// What was reached for how many bytes, where it is not what was asked for: a line for each stack that no smaller one
/// is as good as.
std::string table_of_missed(const CompactChoice& choice, const BsdfOptions& options) {
  std::vector<const CompactFit*> fits;
  for (const CompactFit& fit : choice.tried) fits.push_back(&fit);
  std::sort(fits.begin(), fits.end(), [](const CompactFit* a, const CompactFit* b) {
    return std::make_pair(a->bytes, a->quality.worst_relvar) < std::make_pair(b->bytes, b->quality.worst_relvar);
  });
  std::string text = "  a relvar of " + number(*options.max_variance, 2) + " was not reached within " +
                     std::to_string(options.budget) +
                     " bytes; what was:\n            bytes      relvar  evaluation error  chart\n";
  double least = std::numeric_limits<double>::infinity();
  for (const CompactFit* fit : fits) {
    if (fit->quality.worst_relvar >= least) continue;
    least = fit->quality.worst_relvar;
    char row[96];
    std::snprintf(row, sizeof row, "  %15zu  %10.2g  %14.2g %%  %s%s\n", fit->bytes, least,
                  100 * fit->quality.eval_error, to_string(fit->data.diagrams.chart),
                  fit == &choice.best() ? ", written" : "");
    text += row;
  }
  return text;
}

/// What the chosen stack is, and what it was preferred to.
std::string describe(const CompactChoice& choice, const BsdfOptions& options) {
  const CompactFit& best = choice.best();
  std::string text = std::string("chart ") + to_string(best.data.diagrams.chart) + ", " +
                     std::to_string(best.data.diagrams.theta_i.size()) + " incident angles, " +
                     std::to_string(best.bytes) + " bytes: " + describe(best.quality) + "\n";
  if (missed(best, options)) return text + table_of_missed(choice, options);
  for (std::size_t k = 0; k < choice.tried.size(); ++k) {
    const CompactFit& other = choice.tried[k];
    if (k != choice.chosen)
      text += std::string("  not ") + to_string(other.data.diagrams.chart) + ", " + std::to_string(other.bytes) +
              " bytes: relvar " + number(other.quality.worst_relvar, 2) + ", evaluation error " +
              number(100 * other.quality.eval_error, 2) + " %\n";
  }
  return text;
}

/// The options that decided.
std::string asked_for(const BsdfOptions& options, const StackRequest& request) {
  std::string text = options.max_variance ? "--max-variance " + number(*options.max_variance)
                                          : "--budget " + std::to_string(options.budget);
  if (options.max_variance && request.budget) text += " --budget " + std::to_string(options.budget);
  if (request.chart) text += std::string(" --chart ") + to_string(*request.chart);
  return text;
}

/// The first fit that samples the table with that variance in that many bytes, and its point among those of all.
struct LobeChoice {
  const StageFit* fit = nullptr;
  std::size_t point = 0;
};
LobeChoice smallest_lobes(const std::shared_ptr<const BrdfTable>& table, const TableFits& fits, double max_variance,
                          std::size_t bytes, std::vector<FrontPoint>& points) {
  LobeChoice found;
  for (const StageFit& stage : fits.stages) {
    points.push_back(front_point(table, stage));
    if (!found.fit && points.back().relvar <= max_variance && points.back().bytes <= bytes)
      found = {&stage, points.size() - 1};
  }
  return found;
}

void sized(const std::filesystem::path& in, const std::filesystem::path& out, const StackRequest& request,
           const CellPolicies& policies) {
  const bool any_kind = out.extension().empty();
  std::filesystem::path file = out, stack_file = out;
  if (any_kind) file += ".json", stack_file += ".exr";  // one of the two
  check_not_input(file, {in});
  check_not_input(stack_file, {in});
  const auto table = std::make_shared<const BrdfTable>(load_input(in, policies));
  check_writable(file);
  if (!request.front.empty()) {
    check_not_input(request.front, {in, file, stack_file});
    check_writable(request.front);
  }

  BsdfOptions options;
  if (request.budget) options.budget = *request.budget, options.max_variance.reset();
  if (request.max_variance) options.max_variance = request.max_variance;
  options.chart = request.chart;

  std::vector<FrontPoint> points;
  TableFits fits;
  LobeChoice lobes;
  std::optional<CompactChoice> choice;
  {
    ProgressLine progress("fitting " + in.string());
    if (any_kind || !request.front.empty()) {
      try {
        fits = fit_table(*table, parse_model(default_fit_form));
      } catch (const Error&) {  // a black table, or one of which nothing was measured
      }
      lobes = smallest_lobes(table, fits, any_kind ? *options.max_variance : 0, options.budget, points);
    }
    const double before = any_kind || !request.front.empty() ? 0.4 : 0;
    progress.update(before);
    choice = fit_compact(*table, options, [&](double share) { progress.update(before + (1 - before) * share); });
  }
  const CompactFit& best = choice->best();
  if (lobes.fit && points[lobes.point].bytes >= best.bytes && !missed(best, options)) lobes.fit = nullptr;
  if (lobes.fit) {
    FrontPoint& p = points[lobes.point];
    p.chosen = true;
    write_stream_atomically(file, [&](std::ostream& stream) { stream << to_json(lobes.fit->fit, lobes.fit->errors); });
    std::printf(
        "%s, %zu bytes adapted to the table: relvar at most %s up to 80 degrees; a stack takes %zu bytes for %s\n",
        p.id.c_str(), p.bytes, number(p.relvar, 2).c_str(), best.bytes, number(best.quality.worst_relvar, 2).c_str());
  } else {
    file = stack_file;
    StackFile stack = named(*table, in, asked_for(options, request) + ": " + describe(best.quality), request);
    stack.bsdf = best.data;
    save_stack(file, stack);
    std::printf("%s", describe(*choice, options).c_str());
  }
  if (!request.front.empty()) {
    for (std::size_t k = 0; k < choice->tried.size(); ++k) {
      points.push_back(front_point(choice->tried[k]));
      points.back().chosen = !lobes.fit && k == choice->chosen;
    }
    write_stream_atomically(request.front, [&](std::ostream& stream) {
      stream << front_json(points).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    });
  }
  print_written(file);
  if (!request.front.empty()) print_written(request.front);
}

}  // namespace

void table_to_stack(const CLI::App& verb, const std::filesystem::path& in, const std::filesystem::path& out,
                    const StackRequest& request, const CellPolicies& policies) {
  constexpr const char* hand[] = {"--interpolation", "--grid", "--incident", "--bytes", "--tolerance"};
  const char* given = nullptr;
  for (const char* option : hand)
    if (verb.count(option) > 0) given = option;
  if (!given) {
    sized(in, out, request, policies);
    return;
  }
  for (const char* option : {"--max-variance", "--budget", "--front"})
    if (verb.count(option) > 0)
      throw Error(std::string(option) + ": found one, expected none beside " + given + ", which sets a size by hand");
  by_hand(in, out, request, policies);
}

}  // namespace gonio
