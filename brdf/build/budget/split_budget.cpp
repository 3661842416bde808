#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <string>
#include <tuple>

#include <gonio/brdf/build/budget/split_budget.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

using Curve = std::vector<BudgetPoint>;

/// From the chosen point of a curve to another of it.
struct Step {
  double gain_per_byte;
  std::size_t curve, point;

  // The largest gain first, then the first of the curves: the outcome is one, whatever ties there are.
  bool operator<(const Step& other) const {
    return std::tie(gain_per_byte, other.curve) < std::tie(other.gain_per_byte, curve);
  }
};

void check(const std::vector<Curve>& curves, const std::vector<double>& weights) {
  if (weights.size() != curves.size()) {
    throw Error("budget: weights: found " + std::to_string(weights.size()) + ", expected " +
                std::to_string(curves.size()) + ", one per curve");
  }
  for (std::size_t k = 0; k < curves.size(); ++k) {
    if (!(weights[k] >= 0) || std::isinf(weights[k])) {
      throw Error("budget: weight " + std::to_string(k) + ": found " + std::to_string(weights[k]) +
                  ", expected a finite number >= 0");
    }
    if (curves[k].empty())
      throw Error("budget: curve " + std::to_string(k) + ": found no points, expected at least one");
    for (const BudgetPoint& p : curves[k]) {
      if (!(p.variance >= 0) || std::isinf(p.variance)) {
        throw Error("budget: curve " + std::to_string(k) + ": variance: found " + std::to_string(p.variance) +
                    ", expected a finite number >= 0");
      }
    }
  }
}

}  // namespace

std::vector<std::size_t> split_budget(const std::vector<Curve>& curves, const std::vector<double>& weights,
                                      std::size_t bytes) {
  check(curves, weights);
  std::vector<std::size_t> chosen;
  std::size_t smallest = 0;
  for (const Curve& curve : curves) {
    const auto first = std::min_element(curve.begin(), curve.end(), [](const auto& a, const auto& b) {
      return std::tie(a.bytes, a.variance) < std::tie(b.bytes, b.variance);
    });
    chosen.push_back(static_cast<std::size_t>(first - curve.begin()));
    smallest += first->bytes;
  }
  if (smallest > bytes) {
    throw Error("budget: found " + std::to_string(bytes) + " bytes, expected at least " + std::to_string(smallest) +
                ", what the smallest of every material take together");
  }

  std::size_t left = bytes - smallest;
  const auto best_step = [&](std::size_t k) {
    const BudgetPoint& now = curves[k][chosen[k]];
    std::optional<Step> best;
    for (std::size_t p = 0; p < curves[k].size(); ++p) {
      const BudgetPoint& to = curves[k][p];
      if (to.bytes <= now.bytes || to.bytes - now.bytes > left) continue;
      const Step step{weights[k] * (now.variance - to.variance) / static_cast<double>(to.bytes - now.bytes), k, p};
      if (step.gain_per_byte > 0 && (!best || step.gain_per_byte > best->gain_per_byte)) best = step;
    }
    return best;
  };
  // Of every curve its best step. As bytes are spent, a step may no longer fit, and never becomes
  // better: so it is enough to look again at the one on top.
  std::priority_queue<Step> steps;
  const auto add_step = [&](std::size_t k) {
    if (const auto step = best_step(k)) steps.push(*step);
  };
  for (std::size_t k = 0; k < curves.size(); ++k) add_step(k);
  while (!steps.empty()) {
    const Step step = steps.top();
    steps.pop();
    const std::size_t more = curves[step.curve][step.point].bytes - curves[step.curve][chosen[step.curve]].bytes;
    if (more <= left) {
      left -= more;
      chosen[step.curve] = step.point;
    }
    add_step(step.curve);
  }
  return chosen;
}

}  // namespace gonio
