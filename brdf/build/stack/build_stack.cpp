#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <gonio/brdf/batch/batch_layout.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/build/stack/grow_stack.h>
#include <gonio/mapping/base/error.h>

namespace gonio {

double transfer_density(const BrdfTable& table, double theta_i, const Vec3<double>& wo) {
  const glm::vec3 wi(static_cast<float>(std::sin(theta_i)), 0, static_cast<float>(std::cos(theta_i)));
  const glm::vec3 w(wo);
  const double left = luminance(table.eval(wi, w));
  if (std::holds_alternative<MbsdfTable>(table.data())) return left * wo.z;  // mirrored as it is
  const double right = luminance(table.eval(wi, {w.x, -w.y, w.z}));
  return (left + right) / 2 * wo.z;
}

double disk_density(const BrdfTable& table, Chart chart, double theta_i, Polar<double> at) {
  if (chart == Chart::outgoing) return transfer_density(table, theta_i, polar_to_direction(at));
  const auto d = HalfVectorChart<double>(theta_i).direction(at);
  return transfer_density(table, theta_i, d.wo) * d.jacobian;
}

StackGrid build_stack(const BrdfTable& table, const BsdfOptions& options, const Progress& progress) {
  if (options.incident < 2)
    throw Error("stack: incident: found " + std::to_string(options.incident) + ", expected at least 2");
  const double tolerance = options.max_variance.value_or(*BsdfOptions{}.max_variance);
  if (!(tolerance > 0))
    throw Error("stack: max_variance: found " + std::to_string(tolerance) + ", expected more than 0");
  const Chart chart = options.chart.value_or(Chart::outgoing);
  const bool blend = options.interpolation == Interpolation::blend;
  std::optional<LineFit> shared;
  if (blend) shared.emplace(detail::prepare_lines(table, chart, options.meridians, options.parallels));
  detail::GrowthLimits limits{7, static_cast<std::size_t>(options.incident), options.budget, tolerance,
                              [](const Diagram<double>& d) {
                                return BatchLayout::diagram_bytes(d.meridians(), d.parallels()) +
                                       BatchLayout::lines_bytes(d.meridians(), d.parallels());
                              }};
  // When the memory does not suffice for the tolerance, diagrams of that quality leave too few of
  // them: coarser ones at more angles may do better. The tolerance grows as long as they do.
  std::optional<detail::Grown> best;
  for (bool more = true; more; limits.tolerance *= 2) {
    // The worst of the angles decides on shared lines: it may have what the interpolation is allowed altogether.
    const detail::Recipe recipe =
        blend ? detail::Recipe(table, chart, shared->lines(limits.tolerance))
              : detail::Recipe(table, chart, {options.meridians, options.parallels, limits.tolerance / 2});
    detail::Grown grown = grow_stack(recipe, options.interpolation, limits, progress);
    // Equal: the tolerance was out of reach of the largest diagram, and still is.
    if (best && grown.mean_error > best->mean_error) break;
    more = grown.out_of_bytes;
    best = std::move(grown);
  }
  if (progress) progress(1);
  return std::move(best->grid);
}

}  // namespace gonio
