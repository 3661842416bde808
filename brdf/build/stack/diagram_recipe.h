#pragma once

#include <optional>
#include <vector>

#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/mapping/diagram/diagram_fit.h>

namespace gonio::detail {

/// Prepares lines for all diagrams of a table in a chart (LineFit), from the densities at 14 angles and those of
/// `more` [rad].
LineFit prepare_lines(const BrdfTable& table, Chart chart, int most_meridians, int most_parallels,
                      const std::vector<double>& more = {});

/// How the diagrams of a stack are made: the density in the chart, and the lines if they are shared.
class Recipe {
 public:
  /// Every diagram has lines of its own.
  Recipe(const BrdfTable& table, Chart chart, const FitLimits& limits)
      : table_(table), chart_(chart), limits_(limits) {}
  /// All diagrams have these lines.
  Recipe(const BrdfTable& table, Chart chart, SharedLines lines)
      : table_(table), chart_(chart), shared_(std::move(lines)) {}

  DiskDensity density_at(double theta_i) const;

  /// With the share of a cosine lobe; a cosine lobe alone where the table reflects nothing.
  DiagramGrid diagram(double theta_i) const;

  /// Not next to grazing incidence in half vectors: these squeeze the horizon about the mirror direction of wi into
  /// next to no solid angle, so that what is raised there is a spike that directions in float do not hold.
  bool can_be_raised(double theta_i) const;

  /// Raises a diagram next to the horizon to the table's density at an incident angle divided by `mean` (raise_tail()),
  /// then normalises it. `mean` puts both in one unit: 1 for a diagram that is not yet normalised, otherwise the mass
  /// of that density.
  void raise(double theta_i, double mean, DiagramGrid& grid) const;

  Chart chart() const { return chart_; }
  const BrdfTable& table() const { return table_; }

 private:
  DiagramGrid fitted(const DiskDensity& density) const;

  const BrdfTable& table_;
  Chart chart_;
  FitLimits limits_;
  std::optional<SharedLines> shared_;
};

}  // namespace gonio::detail
