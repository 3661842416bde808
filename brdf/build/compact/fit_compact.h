#pragma once

#include <cstddef>
#include <vector>

#include <gonio/brdf/build/compact/compact_quality.h>
#include <gonio/brdf/build/stack/bsdf_options.h>
#include <gonio/mapping/base/progress.h>

namespace gonio {

/// A BSDF with colours of its own, fitted to a table.
struct CompactFit {
  BsdfData data;      ///< a blend
  std::size_t bytes;  ///< as a Bsdf holds it
  double tolerance;   ///< that the stack was built to
  CompactQuality quality;
};

/// Everything that was built on the way, in the order in which it was; `chosen` is an index.
struct CompactChoice {
  std::vector<CompactFit> tried;
  std::size_t chosen;

  const CompactFit& best() const { return tried[chosen]; }
};

/// Chooses chart, lines, incident angles and colour cells of a BSDF, and measures the result on the
/// table (CompactDraws) instead of trusting the estimates that steer the growth. If the variance asked for is out
/// of reach within the budget, the stack with the smallest worst variance is chosen: see its quality.
/// Deterministic; uses all cores.
/// With a variance asked for, the least bytes that have it at every angle up to 80 degrees, with a colour whose
/// evaluation error is at most a fifth of its root, or hardly larger than that of the finest colour; otherwise the
/// least evaluation error within the budget. The interpolation of the options does not count.
/// @throws Error for a variance that is not > 0, sizes out of range, or a budget of less than 1 KiB or into which
/// nothing fits.
CompactChoice fit_compact(const BrdfTable& table, const BsdfOptions& options = {}, const Progress& progress = {});

/// The diagrams of a BSDF that takes f_r from the table: chosen in the same way, without a colour to fit and to keep
/// room for.
/// @throws Error as fit_compact().
BsdfData fit_diagrams(const BrdfTable& table, const BsdfOptions& options = {}, const Progress& progress = {});

/// The error over the bytes: a fit for each variance asked for (descending), in the better chart of each, those
/// left out that are neither smaller nor better than another. Ascending bytes.
/// @throws Error as fit_compact().
std::vector<CompactFit> compact_curve(const BrdfTable& table, const std::vector<double>& max_variances,
                                      const BsdfOptions& options = {}, const Progress& progress = {});

}  // namespace gonio
