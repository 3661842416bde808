#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include <gonio/brdf/build/stack/grow_stack.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio::detail {
namespace {

constexpr double degree = pi<double> / 180;
// Beyond this, tables hold extrapolated values at best; the last diagram serves the rest.
constexpr double largest_angle = 89.5 * degree;
constexpr double smallest_gap = 0.1 * degree;

/// The incident angles at which a table has values of its own [rad], for a blend, which is linear between its
/// diagrams as such tables are between these; none for MERL, whose angles are others.
std::vector<double> incident_nodes(const BrdfTable& table, Interpolation interpolation) {
  std::vector<double> nodes;
  if (interpolation != Interpolation::blend) return nodes;
  if (const auto* grid = std::get_if<MbsdfTable>(&table.data())) {
    for (int i = 0; i < grid->n_theta_in(); ++i) nodes.push_back((i + 0.5) * pi<double> / 2 / grid->n_theta_in());
  } else if (const auto* rgl = std::get_if<RglTable>(&table.data())) {
    nodes.assign(rgl->theta_i().begin(), rgl->theta_i().end());
  }
  return nodes;
}

struct Built {
  DiagramGrid grid;
  Diagram<double> diagram;
};

/// What the weights of a density are when it is sampled by a map of the square to the disk.
struct MapWeights {
  double mean, relvar;
};
template <class Map>
MapWeights map_weights(const DiskDensity& density, const Map& map) {
  constexpr int side = 64;
  double sum = 0, sum2 = 0;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      // A fixed lattice inside the cells, so that no row or column of samples shares a coordinate.
      const double jitter = (x * 19 + y * 27) % side + 0.5;
      const double v = (y + (side - jitter) / side) / side;
      const auto s = map.sample((x + jitter / side) / side, v, 1 - v);
      const double weight = s.pdf > 0 ? density(s.at) / s.pdf : 0;
      sum += weight;
      sum2 += weight * weight;
    }
  }
  return {sum / (side * side), sum > 0 ? std::max(0.0, sum2 * side * side / (sum * sum) - 1) : 0};
}

/// Diagrams by incident angle, grown until nothing fails or a limit is met.
class Growth {
 public:
  Growth(const Recipe& recipe, Interpolation interpolation, const GrowthLimits& limits, const Progress& progress)
      : recipe_(recipe),
        interpolation_(interpolation),
        limits_(limits),
        progress_(progress),
        nodes_(incident_nodes(recipe.table(), interpolation)) {
    // Constant beyond them, too: such a table has no more to give.
    nodes_alone_ = std::holds_alternative<MbsdfTable>(recipe.table().data()) && recipe.chart() == Chart::outgoing &&
                   interpolation == Interpolation::blend;
    const double first = nodes_alone_ ? nodes_.front() : 0, last = nodes_alone_ ? nodes_.back() : largest_angle;
    std::set<double> start{first, last};
    const std::size_t count = std::min(limits.incident, limits.start);
    for (std::size_t k = 1; k + 1 < count; ++k) {
      const double even = first + (last - first) * static_cast<double>(k) / static_cast<double>(count - 1);
      start.insert(nearest_node(even, first, last).value_or(even));
    }
    build({start.begin(), start.end()});
    while (split_worst()) {
    }
    estimate_errors();
    raise_tails();
  }

  Grown take() {
    Grown result{{}, mean_error(), out_of_bytes_};
    result.grid.chart = recipe_.chart();
    for (auto& [angle, entry] : built_) {
      result.grid.theta_i.push_back(angle);
      result.grid.diagrams.push_back(std::move(entry.grid));
    }
    return result;
  }

 private:
  using Interval = std::map<double, Built>::const_iterator;  // the diagram at its lower end

  std::optional<double> nearest_node(double to, double above, double below) const {
    std::optional<double> nearest;
    for (const double node : nodes_)
      if (node > above + smallest_gap && node < below - smallest_gap &&
          (!nearest || std::abs(node - to) < std::abs(*nearest - to)))
        nearest = node;
    return nearest;
  }

  /// Where an interval is split, if it is worth it.
  std::optional<double> middle(Interval interval) const {
    const double a = interval->first, b = std::next(interval)->first;
    if (const auto node = nearest_node((a + b) / 2, a, b)) return node;
    if (nodes_alone_ || b - a <= 2 * smallest_gap) return std::nullopt;
    return (a + b) / 2;
  }

  /// (The worst would say little: it is often that of an angle where the table is noise and no stack does better.)
  double mean_error() const {
    double sum = 0, weights = 0;
    for (const auto& [angle, error] : error_) {
      const double width = std::next(built_.find(angle))->first - angle;
      sum += error * width;
      weights += weight(built_.find(angle)) * width;
    }
    return weights > 0 ? sum / weights : 0;
  }

  double weight(Interval interval) const { return limits_.weight((interval->first + std::next(interval)->first) / 2); }

  void build(const std::vector<double>& angles) {
    parallel_for(angles.size(), [&](std::size_t k) {
      DiagramGrid grid = recipe_.diagram(angles[k]);
      Diagram<double> diagram(grid);
      const std::lock_guard<std::mutex> lock(mutex_);
      const Built& built = built_.emplace(angles[k], Built{std::move(grid), std::move(diagram)}).first->second;
      bytes_ += limits_.bytes_of(built.diagram);
      if (progress_)
        progress_(std::min(1.0, std::max(static_cast<double>(built_.size()) / static_cast<double>(limits_.incident),
                                         static_cast<double>(bytes_) / static_cast<double>(limits_.bytes))));
    });
  }

  MapWeights weights(double theta_i, const Built& a, const Built& b, double alpha) const {
    const DiskDensity density = recipe_.density_at(theta_i);
    if (interpolation_ == Interpolation::blend) return map_weights(density, Blend<double>(a.diagram, b.diagram, alpha));
    return map_weights(density, Displacement<double>(a.diagram, b.diagram, alpha));
  }

  /// Recipe::diagram() has raised every diagram to its own table's density next to the horizon. Half way to its
  /// neighbours the table may reflect more there.
  void raise_tails() {
    std::vector<Interval> intervals;
    for (Interval it = built_.begin(); std::next(it) != built_.end(); ++it) intervals.push_back(it);
    std::vector<double> means(intervals.size());
    parallel_for(intervals.size(), [&](std::size_t k) {
      const Interval a = intervals[k], b = std::next(a);
      means[k] = weights((a->first + b->first) / 2, a->second, b->second, 0.5).mean;
    });
    parallel_for(built_.size(), [&](std::size_t k) {
      auto& [angle, own] = *std::next(built_.begin(), static_cast<std::ptrdiff_t>(k));
      if (!recipe_.can_be_raised(angle)) return;
      for (const std::size_t interval : {k - 1, k})
        if (interval < intervals.size() && means[interval] > 0)
          recipe_.raise((intervals[interval]->first + std::next(intervals[interval])->first) / 2, means[interval],
                        own.grid);
    });
  }

  void estimate_errors() {
    std::vector<Interval> unknown;
    for (Interval it = built_.begin(); std::next(it) != built_.end(); ++it)
      if (!error_.count(it->first)) unknown.push_back(it);
    constexpr double probes[] = {0.25, 0.5, 0.75};
    constexpr std::size_t count = std::size(probes);
    std::vector<double> estimate(unknown.size() * count, 0.0);
    parallel_for(estimate.size(), [&](std::size_t k) {
      const Interval a = unknown[k / count], b = std::next(a);
      const double alpha = probes[k % count];
      estimate[k] = weights((1 - alpha) * a->first + alpha * b->first, a->second, b->second, alpha).relvar;
    });
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const auto worst = std::max_element(estimate.begin() + k * count, estimate.begin() + (k + 1) * count);
      error_[unknown[k]->first] = *worst * weight(unknown[k]);
    }
  }

  /// Splits the intervals with the largest error, a fixed few at a time, so that the outcome is the
  /// same however many threads share the work. False when nothing is left to split or a limit is met.
  bool split_worst() {
    constexpr std::size_t batch = 4;
    estimate_errors();
    struct Split {
      double error, lower, middle;
    };
    std::vector<Split> splits;
    for (Interval it = built_.begin(); std::next(it) != built_.end(); ++it) {
      const double error = error_.at(it->first);
      if (!(error > limits_.tolerance) || settled_.count(it->first)) continue;
      if (const auto at = middle(it)) splits.push_back({error, it->first, *at});
    }
    std::sort(splits.begin(), splits.end(), [](const Split& a, const Split& b) {
      return a.error != b.error ? a.error > b.error : a.lower < b.lower;
    });
    splits.resize(std::min({splits.size(), batch, limits_.incident - built_.size()}));
    if (splits.empty()) return false;

    std::vector<double> middles;
    middles.reserve(splits.size());
    for (const Split& s : splits) middles.push_back(s.middle);
    build(middles);
    while (bytes_ > limits_.bytes && !splits.empty()) {  // what does not fit goes, the least useful first
      const auto last = built_.find(splits.back().middle);
      bytes_ -= limits_.bytes_of(last->second.diagram);
      built_.erase(last);
      splits.pop_back();
      out_of_bytes_ = true;
    }
    for (const Split& s : splits) {
      // Where a diagram of its own is hardly better than the interpolation was, more angles do not
      // help: the size of the diagram or the noise of the table is the limit there.
      const Built& own = built_.at(s.middle);
      const double floor = weights(s.middle, own, own, 0).relvar * limits_.weight(s.middle);
      if (floor > s.error / 1.5) settled_.insert({s.lower, s.middle});
      error_.erase(s.lower);
    }
    return !out_of_bytes_;
  }

  const Recipe& recipe_;
  const Interpolation interpolation_;
  const GrowthLimits& limits_;
  const Progress& progress_;
  const std::vector<double> nodes_;
  bool nodes_alone_;
  std::mutex mutex_;
  std::map<double, Built> built_;
  std::map<double, double> error_;  // weighted, by the lower end of each interval
  std::set<double> settled_;        // lower ends of intervals that splitting does not improve
  std::size_t bytes_ = 0;
  bool out_of_bytes_ = false;
};

}  // namespace

Grown grow_stack(const Recipe& recipe, Interpolation interpolation, const GrowthLimits& limits,
                 const Progress& progress) {
  return Growth(recipe, interpolation, limits, progress).take();
}

}  // namespace gonio::detail
