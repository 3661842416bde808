#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/build/compact/fit_colour.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/build/stack/grow_stack.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/parallel.h>
#include <gonio/mapping/stack/rounded16.h>

namespace gonio {
namespace {

/// The charts to choose from.
std::vector<Chart> candidates(const BsdfOptions& options) {
  if (options.chart) return {*options.chart};
  return {Chart::half, Chart::outgoing};
}

// Shares of the work, as far as they are alike for most tables: preparing the lines; an attempt, of what is left; and
// growing its diagrams, of an attempt.
constexpr double prepared_share = 0.1, attempt_share = 0.3, growth_share = 0.7;

class Fitter {
 public:
  enum class Colours { none, fitted };

  Fitter(const BrdfTable& table, const BsdfOptions& options, Colours colours, const Progress& progress)
      : table_(table), options_(options), colours_(colours), charts_(candidates(options)), progress_(progress) {
    if (options.max_variance && !(*options.max_variance > 0))
      throw Error("compact fit: max_variance: found " + std::to_string(*options.max_variance) +
                  ", expected more than 0");
    if (options.budget < 1024)
      throw Error("compact fit: budget: found " + std::to_string(options.budget) + " bytes, expected at least 1024");
    for (const int size : {options.incident, options.meridians, options.parallels})
      if (size < 2) throw Error("compact fit: size: found " + std::to_string(size) + ", expected at least 2");
  }

  /// A stack of that tolerance, in that chart, with a colour that errs by `colour_error`, added to `tried`; its
  /// index. Without `cut`: none that is larger than `bytes`. With it: as many diagrams as fit.
  std::optional<std::size_t> attempt(Chart chart, double tolerance, std::size_t bytes, double colour_error, bool cut) {
    const double from = done_, way = attempt_share_ * (until_ - done_);
    const SharedLines& lines = lines_of(chart, tolerance);
    const Size size(lines);
    out_of_bytes_ = true;
    if (size.least() > bytes) return std::nullopt;
    const detail::Recipe recipe(table_, chart, lines);
    detail::GrowthLimits limits{3, static_cast<std::size_t>(options_.incident), bytes - size.lines, tolerance,
                                [&size](const Diagram<double>&) { return size.diagram; }};
    // A variance that is to hold at every angle holds at those that are rarely seen, too.
    if (!options_.max_variance)
      limits.weight = [this](double theta_i) { return incidence_weight(options_.incidence, theta_i); };
    if (cut && colours_ == Colours::fitted) limits.bytes = limits.bytes * 9 / 10;  // the colour's share
    detail::Grown grown = grow_stack(recipe, Interpolation::blend, limits,
                                     [&](double share) { report(from + growth_share * share * way); });
    report(from + growth_share * way);
    out_of_bytes_ = grown.out_of_bytes;
    if (grown.out_of_bytes && !cut) return std::nullopt;
    BsdfData data{rounded16(grown.grid), Interpolation::blend, {}};
    const Stack<float> stack(data.diagrams, data.interpolation);
    const std::size_t stack_bytes = BatchLayout(stack).bytes();
    const DirectionMap map = direction_map(stack);
    const CompactDraws draws(table_, map, options_.incidence);
    CompactFit fit{std::move(data), stack_bytes, tolerance,
                   draws.quality([](float, const CompactDraw& d) { return d.weight; })};
    // A stack that will not be chosen needs no colour.
    const bool wanted = cut || fit.quality.worst_relvar <= options_.max_variance.value_or(fit.quality.worst_relvar);
    if (wanted && colours_ == Colours::fitted) {
      // Not `bytes`: a colour made to fit under another stack's would be a worse one.
      const std::size_t left = options_.budget > stack_bytes + 200 ? options_.budget - stack_bytes - 200 : 0;
      const int finest_side = colour_error > 0 ? 16 : 32;
      detail::ColourFit fitted =
          detail::fit_colour(table_, map, stack.theta_i(), draws, finest_side, left, colour_error);
      fit.data.colour = std::move(fitted.colour), fit.quality = fitted.quality;
      fit.bytes += fit.data.colour.bytes();
    }
    if (fit.bytes > bytes) return std::nullopt;
    report(from + way);
    tried.push_back(std::move(fit));
    failing_ = draws.worst_angles(options_.max_variance.value_or(0), 3);
    return tried.size() - 1;
  }

  /// Weights spread by the root of a variance: an error of the colour of a fifth of that is not worth more cells.
  static double colour_error(double variance) { return 0.2 * std::sqrt(variance); }

  CompactChoice least_bytes() {
    std::optional<std::size_t> best;
    std::size_t bytes = options_.budget;
    prepare_all();
    // The chart with fewer crossings first: it bounds the bytes that are worth a try in the other.
    std::vector<Chart> order = charts_;
    std::map<Chart, std::size_t> crossings;
    for (const Chart chart : order) {
      const SharedLines& lines = lines_of(chart, *options_.max_variance);
      crossings[chart] = lines.across.size() * lines.along.size();
    }
    std::stable_sort(order.begin(), order.end(), [&](Chart a, Chart b) { return crossings[a] < crossings[b]; });
    for (const Chart chart : order) {
      until_ = best ? 1 : 0.7;
      if (const auto found = smallest(chart, *options_.max_variance, bytes)) {
        best = found;
        bytes = tried[*found].bytes;
        report(until_);
      }  // otherwise, there may be much left to do
    }
    if (!best) {
      tried.clear();
      best = least_variance_within_budget(*options_.max_variance);
    }
    return coloured(*best);
  }

  CompactChoice least_error() {
    const std::size_t budget = options_.budget;
    prepare_all();
    for (const Chart chart : charts_) {
      until_ += 0.5 / static_cast<double>(charts_.size());
      // Coarser, as long as there are too few diagrams for the tolerance and that makes it better.
      double least = std::numeric_limits<double>::infinity();
      for (double tolerance = start_tolerance; tolerance < coarsest_tolerance; tolerance *= 4) {
        if (const auto made = attempt(chart, tolerance, budget, 0, true)) {
          const double error = tried[*made].quality.eval_error;
          if (!out_of_bytes_ || error >= least) break;
          least = error;
        }
      }
      report(until_);
    }
    until_ = 1;
    if (tried.empty()) throw Error("compact fit: budget: found " + std::to_string(budget) + " bytes, expected more");
    std::size_t best = least_eval_error();
    // The error falls with about the power 3/4 of the crossings along each of three axes.
    double tolerance = tried[best].tolerance;
    const Chart chart = tried[best].data.diagrams.chart;
    for (int round = 0; round < 4; ++round) {
      const double share = static_cast<double>(tried[best].bytes) / static_cast<double>(budget);
      tolerance *= round == 0 ? std::clamp(std::pow(share, 4.0 / 3), 0.02, 0.7) : 0.6;
      attempt(chart, tolerance, budget, 0, true);
      const std::size_t now = least_eval_error();
      if (now == best && round > 0) break;
      best = now;
    }
    return {std::move(tried), best};
  }

  /// For tables that have no stack of that variance within the budget. Adds to `tried`.
  std::size_t least_variance_within_budget(double max_variance) {
    const std::size_t before = tried.size();
    std::vector<double> tolerances;
    for (double tolerance = max_variance; tolerance < coarsest_tolerance; tolerance *= 2)
      tolerances.push_back(tolerance);
    std::size_t left = charts_.size();
    for (const Chart chart : charts_) {
      until_ = done_ + (1 - done_) / static_cast<double>(left--);
      const auto size = [&](double tolerance) { return Size(lines_of(chart, tolerance)); };
      double least = std::numeric_limits<double>::infinity();
      auto tolerance = std::partition_point(tolerances.begin(), tolerances.end(),
                                            [&](double t) { return size(t).least() > options_.budget; });
      while (tolerance != tolerances.end()) {
        if (const auto made = attempt(chart, *tolerance, options_.budget, colour_error(max_variance), true)) {
          // Once all angles that are wanted fit, more tolerance makes it worse; a little worse is chance before.
          const double worst = tried[*made].quality.worst_relvar;
          if (!out_of_bytes_ || worst > 1.5 * least) break;
          least = std::min(least, worst);
        }
        // Of as large diagrams, as many would fit.
        const Size here = size(*tolerance++);
        const auto as_large = [&](double t) { return size(t).diagram == here.diagram; };
        if (tolerance != tolerances.end() && as_large(*tolerance))
          tolerance = std::partition_point(tolerance, tolerances.end(), as_large);
      }
      report(until_);
    }
    if (tried.size() == before)
      throw Error("compact fit: budget: found " + std::to_string(options_.budget) + " bytes, expected more");
    return least_worst();
  }

  /// Before an attempt that is one of so many that are left, all alike.
  void expect_attempts(std::size_t left) {
    until_ = done_ + (1 - done_) / static_cast<double>(left);
    attempt_share_ = 1;
  }

  std::vector<CompactFit> tried;

 private:
  static constexpr double start_tolerance = 0.003, coarsest_tolerance = 1e3;  // of the latter, lines are 2 x 2

  /// What lines take in memory.
  struct Size {
    std::size_t diagram, lines;  // a diagram; what there is once

    explicit Size(const SharedLines& shared) {
      const auto m = static_cast<int>(shared.across.size()), n = static_cast<int>(shared.along.size());
      diagram = BatchLayout::diagram_bytes(m, n);
      lines = BatchLayout::lines_bytes(m, n) + sizeof(Colour) + 200;
    }
    std::size_t least() const { return lines + 3 * diagram; }
  };

  /// The smallest stack of at most that variance and that many bytes, in one chart.
  std::optional<std::size_t> smallest(Chart chart, double max_variance, std::size_t bytes) {
    std::optional<std::size_t> best;
    double tolerance = max_variance;
    for (int round = 0; round < 5; ++round) {
      const auto made = attempt(chart, tolerance, bytes, colour_error(max_variance), false);
      if (!made) break;
      const double worst = tried[*made].quality.worst_relvar;
      if (worst <= max_variance) {
        if (best && tried[*made].bytes >= tried[*best].bytes) break;
        best = made;
        bytes = tried[*made].bytes;
        // Once more with less of what most bytes are: finer lines leave less to the colour; and the worst angle may
        // be one that hardly depends on the tolerance, so that coarser ones are tried even where it is near the limit.
        const bool colour_is_most = 2 * tried[*made].data.colour.bytes() > bytes;
        if (colour_is_most)
          tolerance = 0.3 * std::min(tolerance, worst);
        else
          tolerance *= std::clamp(0.9 * max_variance / worst, 1.5, 4.0);
      } else {
        if (best) break;
        // Lines that do not see an angle at which the table is special cannot serve it.
        if (round == 0)
          look_at(chart, failing_);
        else
          tolerance *= std::clamp(0.9 * max_variance / worst, 0.4, 0.9);
      }
    }
    return best;
  }

  void prepare_all() {
    std::vector<std::optional<LineFit>> made(charts_.size());
    parallel_for(made.size(), [&](std::size_t k) {
      made[k].emplace(detail::prepare_lines(table_, charts_[k], options_.meridians, options_.parallels));
    });
    for (std::size_t k = 0; k < made.size(); ++k) prepared_.emplace(charts_[k], std::move(*made[k]));
    until_ = prepared_share;
    report(until_);
  }

  /// Has the lines of a chart see these angles, too.
  void look_at(Chart chart, const std::vector<double>& angles) {
    extra_[chart] = angles;
    prepared_.erase(chart);
    lines_[chart].clear();
  }

  const SharedLines& lines_of(Chart chart, double tolerance) {
    const auto found = lines_[chart].find(tolerance);
    if (found != lines_[chart].end()) return found->second;
    return lines_[chart].emplace(tolerance, prepared(chart).lines(tolerance)).first->second;
  }

  const LineFit& prepared(Chart chart) {
    const auto found = prepared_.find(chart);
    if (found != prepared_.end()) return found->second;
    return prepared_
        .emplace(chart, detail::prepare_lines(table_, chart, options_.meridians, options_.parallels, extra_[chart]))
        .first->second;
  }

  /// Without the stacks that were found wanting before they had a colour.
  CompactChoice coloured(std::size_t best) {
    CompactChoice choice{{}, 0};
    for (std::size_t k = 0; k < tried.size(); ++k) {
      if (colours_ == Colours::fitted && tried[k].data.colour.empty()) continue;
      if (k == best) choice.chosen = choice.tried.size();
      choice.tried.push_back(std::move(tried[k]));
    }
    return choice;
  }

  std::size_t least_worst() const {
    return static_cast<std::size_t>(std::min_element(tried.begin(), tried.end(),
                                                     [](const CompactFit& a, const CompactFit& b) {
                                                       return std::make_pair(a.quality.worst_relvar, a.bytes) <
                                                              std::make_pair(b.quality.worst_relvar, b.bytes);
                                                     }) -
                                    tried.begin());
  }

  std::size_t least_eval_error() const {
    return static_cast<std::size_t>(std::min_element(tried.begin(), tried.end(),
                                                     [](const CompactFit& a, const CompactFit& b) {
                                                       return a.quality.eval_error < b.quality.eval_error;
                                                     }) -
                                    tried.begin());
  }

  /// Never less than before.
  void report(double done) {
    done_ = std::max(done_, done);
    if (progress_) progress_(done_);
  }

  const BrdfTable& table_;
  const BsdfOptions& options_;
  const Colours colours_;
  const std::vector<Chart> charts_;
  const Progress& progress_;
  std::map<Chart, LineFit> prepared_;
  std::map<Chart, std::map<double, SharedLines>> lines_;  // by tolerance
  std::map<Chart, std::vector<double>> extra_;            // angles that lines must see
  // Of the last attempt: angles with too large a variance, and whether diagrams were left out.
  std::vector<double> failing_;
  bool out_of_bytes_ = false;
  // What is reported: where it is, and up to where the attempts at hand may take it.
  double done_ = 0, until_ = 1, attempt_share_ = attempt_share;
};

}  // namespace

CompactChoice fit_compact(const BrdfTable& table, const BsdfOptions& options, const Progress& progress) {
  Fitter fitter(table, options, Fitter::Colours::fitted, progress);
  CompactChoice choice = options.max_variance ? fitter.least_bytes() : fitter.least_error();
  if (progress) progress(1);
  return choice;
}

BsdfData fit_diagrams(const BrdfTable& table, const BsdfOptions& options, const Progress& progress) {
  // The error of f_r without a table is that of the colours, too.
  if (!options.max_variance) {
    BsdfData data = fit_compact(table, options, progress).best().data;
    data.colour = {};
    return data;
  }
  Fitter fitter(table, options, Fitter::Colours::none, progress);
  BsdfData data = fitter.least_bytes().best().data;
  if (progress) progress(1);
  return data;
}

std::vector<CompactFit> compact_curve(const BrdfTable& table, const std::vector<double>& max_variances,
                                      const BsdfOptions& options, const Progress& progress) {
  for (const double max_variance : max_variances)
    if (!(max_variance > 0))
      throw Error("compact fit: max_variances: found " + std::to_string(max_variance) + ", expected more than 0");
  BsdfOptions without_goal = options;  // every stack of the curve is wanted
  without_goal.max_variance.reset();
  Fitter fitter(table, without_goal, Fitter::Colours::fitted, progress);
  const std::vector<Chart> tried_charts = candidates(options);
  std::size_t left = max_variances.size() * tried_charts.size();
  for (const double max_variance : max_variances) {
    std::size_t bytes = options.budget;
    for (const Chart chart : tried_charts) {
      fitter.expect_attempts(left--);
      if (const auto made = fitter.attempt(chart, max_variance, bytes, Fitter::colour_error(max_variance), false))
        bytes = fitter.tried[*made].bytes;
    }
  }
  if (fitter.tried.empty()) fitter.least_variance_within_budget(1);
  std::vector<CompactFit> curve;
  std::stable_sort(fitter.tried.begin(), fitter.tried.end(), [](const CompactFit& a, const CompactFit& b) {
    return std::make_pair(a.bytes, a.quality.mean_relvar) < std::make_pair(b.bytes, b.quality.mean_relvar);
  });
  for (CompactFit& fit : fitter.tried)
    if (curve.empty() || fit.quality.mean_relvar < curve.back().quality.mean_relvar) curve.push_back(std::move(fit));
  return curve;
}

}  // namespace gonio
