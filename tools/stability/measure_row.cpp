#include "tools/stability/measure_row.h"

#include <algorithm>
#include <cmath>

#include <gonio/brdf/proof/statistics/chi_square.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {
namespace {

constexpr std::uint64_t draws = 1u << 17;
constexpr int error_points = 1 << 12;
/// Quadrature of the expected value: what proof::Bins states, spread over cells of either sign.
constexpr double quadrature_error = 3e-4;

/// Edges at the lines of the diagrams and at quantiles of `x`; none closer than the floats resolve.
std::vector<double> edges(std::vector<double> x, const std::vector<double>& lines, int quantiles, double first,
                          double last) {
  std::sort(x.begin(), x.end());
  std::vector<double> wanted = lines;
  for (int k = 1; k < quantiles; ++k)
    wanted.push_back(x[x.size() * static_cast<std::size_t>(k) / static_cast<std::size_t>(quantiles)]);
  std::sort(wanted.begin(), wanted.end());
  std::vector<double> result{first};
  for (const double w : wanted) {
    const double gap = std::max(3e-6 * std::abs(w), 1e-9);
    if (w - result.back() > gap && last - w > gap) result.push_back(w);
  }
  result.push_back(last);
  return result;
}

/// Bins that follow the lines and the mass of the input: a lobe of any width is cut into many cells.
proof::Bins bins_of(const StabilityInput& input, bool both) {
  StackGrid grid{{0.5}, {input.first}};
  if (both) grid.theta_i.push_back(0.9), grid.diagrams.push_back(input.second);
  const Stack<double> stack(grid, Interpolation::displacement);
  std::vector<double> phi, r, phi_lines, r_lines;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) {
      const Polar<double> p = direction_to_polar(stack.sample(0.66, (i + 0.5) / 64, (j + 0.5) / 64).wo);
      phi.push_back(p.phi);
      r.push_back(p.r);
    }
  for (const DiagramGrid& d : grid.diagrams) {
    for (const double x : d.phi) {
      const double wrapped = std::remainder(x, 2 * pi<double>);
      phi_lines.push_back(wrapped);
      if (d.azimuth == Azimuth::half) phi_lines.push_back(-wrapped);
    }
    r_lines.insert(r_lines.end(), d.r.begin(), d.r.end());
  }
  return {edges(std::move(phi), phi_lines, both ? 25 : 33, -pi<double>, pi<double>),
          edges(std::move(r), r_lines, both ? 17 : 25, 0, 1)};
}

/// What is integrated together with the value: smooth, and different in every direction of change.
double environment(const glm::vec3& w) { return (1 + 0.9 * w.x) * (0.2 + w.z); }

StabilityRow measure_row(const Variant& variant, const StabilityInput& input, const proof::Bins& bins,
                         double significance, std::uint32_t seed) {
  StabilityRow row{variant.name, input.name, variant.error_of, variant.why, 0, variant.bound, 0, 0, 0, 0, false,
                   false,        false};

  proof::Random random(seed);
  constexpr float special[] = {0x1p-24f, 0x1p-12f, 0.25f, 0.5f, 1 - 0x1p-24f};
  for (const float u : special)
    for (const float v : special) row.max_error = std::max(row.max_error, variant.error(u, v));
  for (int k = 0; k < error_points; ++k) {
    const glm::vec2 x = random.pair();
    // Half of the points crowd at the pole, where angles lose their digits.
    row.max_error = std::max(row.max_error, variant.error(x.x, k % 2 ? x.y : x.y * x.y * x.y * x.y));
  }

  double sum = 0, sum2 = 0;
  const auto draw = [&](std::uint64_t) -> std::optional<glm::vec3> {
    const glm::vec2 x = random.pair();
    const Variant::Draw d = variant.sample(x.x, x.y);
    const bool good = std::isfinite(d.wo.x + d.wo.y + d.wo.z) && d.pdf > 0 && std::isfinite(d.pdf);
    const double w = good ? variant.value(d.wo) / d.pdf * environment(d.wo) : 0;  // as renderers drop them
    sum += w;
    sum2 += w * w;
    return d.wo;
  };
  const proof::ChiSquare chi2 = proof::chi_square(draw, variant.pdf, bins, draws);
  row.chi2_p = chi2.p;
  row.lost = chi2.outside + chi2.where_zero;

  double expected = 0;
  for (const double e : bins.integrate([&](const glm::vec3& w) { return variant.value(w) * environment(w); }))
    expected += e;
  const double count = static_cast<double>(draws), mean = sum / count;
  row.bias = mean / expected - 1;
  row.standard_error = std::sqrt(std::max(sum2 / count - mean * mean, 0.0) / count) / expected;

  row.error_fails = !(row.max_error <= row.bound);
  row.bias_fails = !(std::abs(row.bias) <= 5 * row.standard_error + quadrature_error);
  row.chi2_fails = !chi2.passed(significance);
  return row;
}

}  // namespace

std::vector<StabilityRow> measure_input(const StabilityInput& input, int rows, std::uint32_t seed) {
  const proof::Bins one = bins_of(input, false), two = bins_of(input, true);
  std::vector<StabilityRow> result;
  for (const Variant& variant : make_variants(input)) {
    const bool stack = variant.bound > 100;
    result.push_back(measure_row(variant, input, stack ? two : one, proof::sidak(0.01, rows), seed++));
  }
  return result;
}

}  // namespace gonio
