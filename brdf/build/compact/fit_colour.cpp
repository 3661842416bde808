#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include <gonio/brdf/build/compact/fit_colour.h>

namespace gonio::detail {
namespace {

/// Every 2 x 2 cells as their mean: what colour_of_table() gives for half the side.
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

}  // namespace

ColourFit fit_colour(const BrdfTable& table, const DirectionMap& map, const std::vector<float>& stack_angles,
                     const CompactDraws& draws, int finest_side, std::size_t bytes, double enough) {
  std::vector<ColourFit> candidates;
  const auto add = [&](const Colour& cells) { candidates.push_back({cells, draws.quality(cells)}); };
  const Colour finest = colour_of_table(table, map, colour_angles(stack_angles), finest_side);
  const std::vector<std::size_t> order = spare_layers(finest);
  for (std::size_t spared = 0;; spared += (order.size() - spared + 3) / 4) {
    for (Colour cells = without(finest, order, spared);; cells = coarser(cells)) {
      const bool smallest = spared == order.size() && cells.side() == 2;
      if (cells.bytes() <= bytes || (smallest && candidates.empty())) add(cells);
      if (cells.side() == 2) break;
    }
    if (spared == order.size()) break;
  }
  double error = std::numeric_limits<double>::infinity(), albedo = error;
  for (const ColourFit& c : candidates) {
    error = std::min(error, c.quality.eval_error);
    albedo = std::min(albedo, c.quality.albedo_error);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const ColourFit& a, const ColourFit& b) { return a.colour.bytes() < b.colour.bytes(); });
  for (ColourFit& c : candidates)
    if (c.quality.eval_error <= std::max(enough, 1.05 * error + 5e-4) &&
        c.quality.albedo_error <= std::max(0.003, 1.1 * albedo))
      return std::move(c);
  // No candidate is good in both respects: the nearest.
  return std::move(*std::min_element(candidates.begin(), candidates.end(), [](const ColourFit& a, const ColourFit& b) {
    return a.quality.eval_error + a.quality.albedo_error < b.quality.eval_error + b.quality.albedo_error;
  }));
}

}  // namespace gonio::detail
