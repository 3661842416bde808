#include <gonio/brdf/choose_stack.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <gonio/brdf/parallel.h>

namespace gonio {
namespace {

double relvar(const BrdfTable& table, const Stack<float>& stack, double theta_i) {
  constexpr int side = 128;
  std::mt19937 random(1);
  const auto jittered = [&](int k) { return (static_cast<float>(k) + static_cast<float>(random() >> 8) * 0x1p-24f) / side; };
  double sum = 0, sum2 = 0;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const float u = jittered(i), v = jittered(j);
      const auto s = stack.sample(static_cast<float>(theta_i), u, v);
      const double w = s.pdf > 0 ? transfer_density(table, theta_i, Vec3<double>(s.wo)) / static_cast<double>(s.pdf) : 0;
      sum += w;
      sum2 += w * w;
    }
  }
  return sum > 0 ? std::max(0.0, sum2 * side * side / (sum * sum) - 1) : 0;
}

}  // namespace

double rate_stack(const BrdfTable& table, const Stack<float>& stack) {
  constexpr std::size_t count = std::size(rating_angles);
  double found[count];
  parallel_for(count, [&](std::size_t k) { found[k] = relvar(table, stack, rating_angles[k] * pi<double> / 180); });
  double sum = 0;
  for (const double r : found) sum += r / count;
  return sum;
}

std::vector<RatedStack> choose_stack(const BrdfTable& table, const std::vector<StackOptions>& candidates,
                                     const Progress& progress) {
  std::vector<RatedStack> rated;
  for (const StackOptions& options : candidates) {
    const double done = static_cast<double>(rated.size()), all = static_cast<double>(candidates.size());
    StackGrid grid = build_stack(table, options, [&](double share) {
      if (progress) progress((done + share) / all);
    });
    const double found = rate_stack(table, Stack<float>(grid, options.interpolation));
    rated.push_back({std::move(grid), options.interpolation, found});
  }
  std::stable_sort(rated.begin(), rated.end(), [](const RatedStack& a, const RatedStack& b) { return a.relvar < b.relvar; });
  return rated;
}

}  // namespace gonio
