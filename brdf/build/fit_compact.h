#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <gonio/brdf/build/build_stack.h>
#include <gonio/brdf/bsdf/compact_bsdf.h>
#include <gonio/brdf/build/compact_quality.h>

namespace gonio {

/// What a compact BSDF is to be: as small as `max_variance` allows, or as near to the table as `budget` allows.
struct CompactOptions {
  /// The least bytes whose relative variance is at most this at every angle up to 80 degrees, with a colour whose
  /// evaluation error is at most a fifth of its root, or hardly larger than that of the finest colour. None: the
  /// least evaluation error within the budget.
  std::optional<double> max_variance = 0.003;
  std::size_t budget = 256 * 1024;  ///< at most this many bytes
  std::vector<Chart> candidates{Chart::half, Chart::outgoing};
  Incidence incidence;  ///< where the error counts; `max_variance` holds at every angle all the same
};

/// A compact BSDF as data: what a stack file holds.
struct CompactFit {
  StackGrid diagrams;  ///< as they are sampled: blend, packed16
  Colour colour;
  std::size_t bytes;   ///< of the CompactBsdf
  double tolerance;    ///< that the stack was built to
  CompactQuality quality;

  CompactBsdf bsdf() const { return CompactBsdf(diagrams, Interpolation::blend, Storage::packed16, colour); }
};

/// Everything that was built on the way, in the order in which it was; `chosen` is an index.
struct CompactChoice {
  std::vector<CompactFit> tried;
  std::size_t chosen;

  const CompactFit& best() const { return tried[chosen]; }
};

/// Chooses chart, lines, incident angles and colour cells of a compact BSDF, and measures the result on the
/// table (CompactDraws) instead of trusting the estimates that steer the growth. If the variance asked for is out
/// of reach within the budget, the stack with the smallest worst variance is chosen: see its quality.
/// Deterministic; uses all cores.
/// @throws Error for a variance that is not > 0, no candidates, or a budget of less than 1 KiB or into which nothing
///   fits.
CompactChoice fit_compact(const BrdfTable& table, const CompactOptions& options = {}, const Progress& progress = {});

/// The error over the bytes: a fit for each variance asked for (descending), in the better chart of each, those
/// left out that are neither smaller nor better than another. Ascending bytes.
/// @throws Error as fit_compact().
std::vector<CompactFit> compact_curve(const BrdfTable& table, const std::vector<double>& max_variances,
                                      const CompactOptions& options = {}, const Progress& progress = {});

}  // namespace gonio
