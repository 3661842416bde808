#include <gonio/brdf/fit_compact.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include <gonio/brdf/grow.h>
#include <gonio/brdf/parallel.h>
#include <gonio/mapping/error.h>

namespace gonio {
namespace {

constexpr int most_meridians = 64, most_parallels = 48;
constexpr int finest_side = 16;  // of the colour

/// Every 2 x 2 cells as their mean: what from_table() gives for half the side.
Colour coarser(const Colour& colour) {
  const std::vector<glm::vec3> values = colour.values();
  const int side = colour.side() / 2, rows = static_cast<int>(colour.theta_i().size()) * std::max(side / 2, 1);
  std::vector<glm::vec3> means;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto at = [&](int dx, int dy) {
        return values[static_cast<std::size_t>((2 * row + dy) * 2 * side + 2 * column + dx)];
      };
      means.push_back((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) * 0.25f);
    }
  }
  return Colour(colour.theta_i(), side, means);
}

/// The angles of the stack and those half way between: W bends at the first, and the latter tell whether it
/// is straight between them.
std::vector<float> colour_angles(const std::vector<float>& stack_angles) {
  constexpr std::size_t most = 96;
  std::vector<float> angles;
  for (std::size_t k = 0; k < stack_angles.size(); ++k) {
    if (k > 0 && stack_angles.size() <= most / 2) angles.push_back((stack_angles[k - 1] + stack_angles[k]) / 2);
    angles.push_back(stack_angles[k]);
  }
  return angles;
}

/// The layers of a colour in the order in which they can be spared: each time the one that lies nearest to the
/// line between its neighbours.
std::vector<std::size_t> spare_layers(const Colour& colour) {
  const std::vector<glm::vec3> values = colour.values();
  const std::vector<float>& theta_i = colour.theta_i();
  const std::size_t layer = values.size() / theta_i.size();
  std::vector<std::size_t> left(theta_i.size()), spared;
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = k;
  const auto error = [&](std::size_t i) {
    const std::size_t a = left[i - 1], b = left[i], c = left[i + 1];
    const float t = (theta_i[b] - theta_i[a]) / (theta_i[c] - theta_i[a]);
    double sum = 0;
    for (std::size_t k = 0; k < layer; ++k) {
      const glm::vec3 d = glm::abs(values[b * layer + k] - (1 - t) * values[a * layer + k] - t * values[c * layer + k]);
      sum += static_cast<double>(d.x + d.y + d.z);
    }
    return sum * std::sin(2 * static_cast<double>(theta_i[b])) * static_cast<double>(theta_i[c] - theta_i[a]);
  };
  while (left.size() > 2) {
    std::size_t least = 1;
    double least_error = error(1);
    for (std::size_t i = 2; i + 1 < left.size(); ++i)
      if (const double e = error(i); e < least_error) least = i, least_error = e;
    spared.push_back(left[least]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return spared;
}

Colour without(const Colour& colour, const std::vector<std::size_t>& order, std::size_t count) {
  const std::vector<glm::vec3> values = colour.values();
  const std::size_t layer = values.size() / colour.theta_i().size();
  std::vector<bool> dropped(colour.theta_i().size());
  for (std::size_t k = 0; k < count; ++k) dropped[order[k]] = true;
  std::vector<float> theta_i;
  std::vector<glm::vec3> kept;
  for (std::size_t k = 0; k < dropped.size(); ++k) {
    if (dropped[k]) continue;
    theta_i.push_back(colour.theta_i()[k]);
    kept.insert(kept.end(), values.begin() + static_cast<std::ptrdiff_t>(k * layer),
                values.begin() + static_cast<std::ptrdiff_t>((k + 1) * layer));
  }
  return Colour(std::move(theta_i), colour.side(), kept);
}

/// The smallest colour whose evaluation error is at most `enough`, or hardly larger than that of any that fits into
/// `bytes`; the smallest of all if none fits.
std::pair<Colour, CompactQuality> choose_colour(const BrdfTable& table, const DirectionMap& map, const std::vector<float>& stack_angles,
                                                const CompactDraws& draws, std::size_t bytes, double enough) {
  struct Candidate {
    Colour colour;
    CompactQuality quality;
  };
  std::vector<Candidate> candidates;
  const Colour finest = Colour::from_table(table, map, colour_angles(stack_angles), finest_side);
  const std::vector<std::size_t> order = spare_layers(finest);
  for (std::size_t spared = 0;; spared += (order.size() - spared + 3) / 4) {
    for (Colour cells = without(finest, order, spared);; cells = coarser(cells)) {
      if (cells.bytes() <= bytes || cells.theta_i().size() == 2) candidates.push_back({cells, draws.quality(cells)});
      if (cells.side() == 2) break;
    }
    if (spared == order.size()) break;
  }
  double error = std::numeric_limits<double>::infinity(), albedo = error;
  for (const Candidate& c : candidates) {
    error = std::min(error, c.quality.eval_error);
    albedo = std::min(albedo, c.quality.albedo_error);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.colour.bytes() < b.colour.bytes(); });
  for (Candidate& c : candidates)
    if (c.quality.eval_error <= std::max(enough, 1.05 * error + 5e-4) && c.quality.albedo_error <= std::max(0.003, 1.1 * albedo))
      return {std::move(c.colour), c.quality};
  // No candidate is good in both respects: the nearest.
  Candidate& nearest = *std::min_element(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.quality.eval_error < b.quality.eval_error;
  });
  return {std::move(nearest.colour), nearest.quality};
}

class Fitter {
 public:
  Fitter(const BrdfTable& table, const CompactOptions& options, const Progress& progress)
      : table_(table), options_(options), progress_(progress) {
    if (options.max_variance && !(*options.max_variance > 0))
      throw Error("compact fit: max_variance: found " + std::to_string(*options.max_variance) + ", expected more than 0");
    if (options.budget < 1024)
      throw Error("compact fit: budget: found " + std::to_string(options.budget) + " bytes, expected at least 1024");
    if (options.candidates.empty()) throw Error("compact fit: candidates: found no chart, expected at least one");
  }

  /// A stack of that tolerance, in that chart, added to `tried`; its index. Without `cut`: none that is larger
  /// than `bytes`. With it: as many diagrams as fit.
  std::optional<std::size_t> attempt(Chart chart, double tolerance, std::size_t bytes, bool cut) {
    const SharedLines lines = prepared(chart).lines(tolerance);
    const std::size_t m = lines.across.size(), n = lines.along.size();
    // PackedStack: codes, mass up to each meridian, mass up to each block of eight cells.
    const std::size_t diagram = m * n * 2 + m * 4 + m * ((n + 6) / 8) * 4 + 8;
    const std::size_t lines_bytes = (m + n) * 4 + sizeof(CompactBsdf) + 200;
    const std::size_t least = lines_bytes + 3 * diagram;
    if (least > bytes) return std::nullopt;
    const detail::Recipe recipe(table_, chart, lines);
    detail::GrowthLimits limits{3, 192, bytes - lines_bytes, tolerance, [diagram](const Diagram<double>&) { return diagram; },
                                [this](double theta_i) { return incidence_weight(options_.incidence, theta_i); }};
    if (cut) limits.bytes = limits.bytes * 9 / 10;  // the colour's share
    detail::Grown grown = grow_stack(recipe, Interpolation::blend, limits, {});
    if (grown.out_of_bytes && !cut) return std::nullopt;
    const PackedStack stack(grown.grid);
    const DirectionMap map = direction_map(stack);
    const CompactDraws draws(table_, map, options_.incidence);
    CompactFit fit{stack.grid(), {}, stack.bytes(), tolerance,
                   draws.quality([](float, const CompactDraw& d) { return d.weight; })};
    // A stack that will not be chosen needs no colour.
    if (cut || fit.quality.worst_relvar <= options_.max_variance.value_or(fit.quality.worst_relvar)) {
      const std::size_t left = bytes > stack.bytes() + 200 ? bytes - stack.bytes() - 200 : 0;
      std::tie(fit.colour, fit.quality) = choose_colour(table_, map, stack.theta_i(), draws, left, enough_error());
      fit.bytes = fit.bsdf().bytes();
    }
    if (fit.bytes > bytes) return std::nullopt;
    tried.push_back(std::move(fit));
    failing_ = draws.worst_angles(options_.max_variance.value_or(0), 3);
    return tried.size() - 1;
  }

  /// The smallest stack of at most that variance and that many bytes, in one chart.
  std::optional<std::size_t> smallest(Chart chart, double max_variance, std::size_t bytes) {
    std::optional<std::size_t> best;
    double tolerance = max_variance;
    for (int round = 0; round < 4; ++round) {
      const auto made = attempt(chart, tolerance, bytes, false);
      if (!made) break;
      const double worst = tried[*made].quality.worst_relvar;
      if (worst <= max_variance) {
        if (!best || tried[*made].bytes < tried[*best].bytes) best = made;
        // Better than was asked for: once more, with less.
        if (worst > 0.7 * max_variance || round > 0) break;
        bytes = tried[*made].bytes;
        tolerance *= std::min(2.0, 0.9 * max_variance / std::max(worst, 1e-9));
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

  CompactChoice least_bytes() {
    std::optional<std::size_t> best;
    std::size_t bytes = options_.budget;
    double done = 0;
    prepare_all();
    // The chart with fewer crossings first: it bounds the bytes that are worth a try in the other.
    std::vector<Chart> order = options_.candidates;
    std::map<Chart, std::size_t> crossings;
    for (const Chart chart : order) {
      const SharedLines lines = prepared(chart).lines(*options_.max_variance);
      crossings[chart] = lines.across.size() * lines.along.size();
    }
    std::stable_sort(order.begin(), order.end(), [&](Chart a, Chart b) { return crossings[a] < crossings[b]; });
    for (const Chart chart : order) {
      if (const auto found = smallest(chart, *options_.max_variance, bytes)) {
        best = found;
        bytes = tried[*found].bytes;
      }
      report(done += 1.0 / static_cast<double>(options_.candidates.size()));
    }
    if (!best) best = least_variance_within_budget();
    return coloured(*best);
  }

  CompactChoice least_error() {
    const std::size_t budget = options_.budget;
    prepare_all();
    for (const Chart chart : options_.candidates) {
      attempt(chart, start_tolerance, budget, true);
      report(0.3 * static_cast<double>(tried.size()));
    }
    for (double tolerance = 0.1; tried.empty() && tolerance < 1e3; tolerance *= 4)  // lines of 2 x 2 in the end
      for (const Chart chart : options_.candidates) attempt(chart, tolerance, budget, true);
    if (tried.empty()) throw Error("compact fit: budget: found " + std::to_string(budget) + " bytes, expected more");
    std::size_t best = least_eval_error();
    // The error falls with about the power 3/4 of the crossings along each of three axes.
    double tolerance = tried[best].tolerance;
    const Chart chart = tried[best].diagrams.chart;
    for (int round = 0; round < 4; ++round) {
      const double share = static_cast<double>(tried[best].bytes) / static_cast<double>(budget);
      tolerance *= round == 0 ? std::clamp(std::pow(share, 4.0 / 3), 0.02, 0.7) : 0.6;
      attempt(chart, tolerance, budget, true);
      report(0.6 + 0.1 * round);
      const std::size_t now = least_eval_error();
      if (now == best && round > 0) break;
      best = now;
    }
    return {std::move(tried), best};
  }

  std::vector<CompactFit> tried;

 private:
  static constexpr double start_tolerance = 0.003;

  /// Weights spread by the root of the variance allowed: an error of less than a third of that is not worth more cells.
  double enough_error() const { return options_.max_variance ? 0.3 * std::sqrt(*options_.max_variance) : 0; }

  void prepare_all() {
    std::vector<std::optional<LineFit>> made(options_.candidates.size());
    parallel_for(made.size(), [&](std::size_t k) {
      made[k].emplace(detail::prepare_lines(table_, options_.candidates[k], most_meridians, most_parallels));
    });
    for (std::size_t k = 0; k < made.size(); ++k) prepared_.emplace(options_.candidates[k], std::move(*made[k]));
  }

  /// Has the lines of a chart see these angles, too.
  void look_at(Chart chart, const std::vector<double>& angles) {
    extra_[chart] = angles;
    prepared_.erase(chart);
  }

  const LineFit& prepared(Chart chart) {
    const auto found = prepared_.find(chart);
    if (found != prepared_.end()) return found->second;
    return prepared_.emplace(chart, detail::prepare_lines(table_, chart, most_meridians, most_parallels, extra_[chart])).first->second;
  }

  /// Without the stacks that were found wanting before they had a colour.
  CompactChoice coloured(std::size_t best) {
    CompactChoice choice{{}, 0};
    for (std::size_t k = 0; k < tried.size(); ++k) {
      if (tried[k].colour.empty()) continue;
      if (k == best) choice.chosen = choice.tried.size();
      choice.tried.push_back(std::move(tried[k]));
    }
    return choice;
  }

  std::size_t least_variance_within_budget() {
    tried.clear();
    for (double tolerance = *options_.max_variance; tolerance < 1e3; tolerance *= 4) {
      for (const Chart chart : options_.candidates) attempt(chart, tolerance, options_.budget, true);
      // Once all angles that are wanted fit, more tolerance makes it worse.
      if (tried.size() > 2 && tried.back().quality.worst_relvar > tried[least_worst()].quality.worst_relvar) break;
    }
    if (tried.empty())
      throw Error("compact fit: budget: found " + std::to_string(options_.budget) + " bytes, expected more");
    return least_worst();
  }

  std::size_t least_worst() const {
    return static_cast<std::size_t>(std::min_element(tried.begin(), tried.end(), [](const CompactFit& a, const CompactFit& b) {
                                      return a.quality.worst_relvar < b.quality.worst_relvar;
                                    }) - tried.begin());
  }

  std::size_t least_eval_error() const {
    return static_cast<std::size_t>(std::min_element(tried.begin(), tried.end(), [](const CompactFit& a, const CompactFit& b) {
                                      return a.quality.eval_error < b.quality.eval_error;
                                    }) - tried.begin());
  }

  void report(double done) {
    if (progress_) progress_(std::min(done, 1.0));
  }

  const BrdfTable& table_;
  const CompactOptions& options_;
  const Progress& progress_;
  std::map<Chart, LineFit> prepared_;
  std::map<Chart, std::vector<double>> extra_;  // angles that lines must see
  std::vector<double> failing_;                 // angles of the last attempt
};

}  // namespace

CompactChoice fit_compact(const BrdfTable& table, const CompactOptions& options, const Progress& progress) {
  Fitter fitter(table, options, progress);
  CompactChoice choice = options.max_variance ? fitter.least_bytes() : fitter.least_error();
  if (progress) progress(1);
  return choice;
}

std::vector<CompactFit> compact_curve(const BrdfTable& table, const std::vector<double>& max_variances,
                                      const CompactOptions& options, const Progress& progress) {
  CompactOptions without_goal = options;  // every stack of the curve is wanted
  without_goal.max_variance.reset();
  Fitter fitter(table, without_goal, progress);
  double done = 0;
  for (const double max_variance : max_variances) {
    std::size_t bytes = options.budget;
    for (const Chart chart : options.candidates)
      if (const auto made = fitter.attempt(chart, max_variance, bytes, false)) bytes = fitter.tried[*made].bytes;
    if (progress) progress(done += 1 / static_cast<double>(max_variances.size()));
  }
  std::vector<CompactFit> curve;
  std::stable_sort(fitter.tried.begin(), fitter.tried.end(), [](const CompactFit& a, const CompactFit& b) { return a.bytes < b.bytes; });
  for (CompactFit& fit : fitter.tried)
    if (curve.empty() || fit.quality.mean_relvar < curve.back().quality.mean_relvar) curve.push_back(std::move(fit));
  return curve;
}

}  // namespace gonio
