#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <gonio/mapping/diagram/diagram.h>

namespace gonio {

/// How large a fitted diagram may become, and when it is good enough.
struct FitLimits {
  int meridians = 40;        ///< at most this many, >= 2
  int parallels = 40;        ///< at most this many, >= 2
  double tolerance = 0.002;  ///< relative variance that ends the growth; 0 takes all the lines allowed
};

/// A density at (r, phi) of the disk [any scale]; phi in [0, pi] or [0, 2 pi]. Called from one thread,
/// some 10^4 times a diagram. Non-finite or negative values count as 0.
using DiskDensity = std::function<double(Polar<double>)>;

/// Chooses lines and densities of a diagram from a density function, so that the bilinear diagram is
/// as close to it as its size allows, in the sense that decides sampling quality: the chi-square
/// divergence, which is the relative variance of the estimate.
///
/// 1. The function is tabulated on a reference grid, finer than the diagram, whose lines move to
///    where it bends (two coarse rounds, then the full one).
/// 2. Of the reference lines those are kept, per axis, that minimise the summed squared error of
///    linear interpolation relative to the density: an exact optimum by dynamic programming, for
///    every number of lines at once. The smallest M x N within the tolerance is taken; where
///    step 3 then falls short of it, a larger one.
/// 3. The densities at the crossings are fitted by Richardson-Lucy (EM) steps, which keep them
///    positive, conserve the mass and descend on the divergence. Interpolating the function at the
///    crossings would leave several times its variance. The pole is one value for all meridians.
///
/// @return a grid with the scale of `density`; a function that is 0 everywhere gives zeros.
/// @throws Error for limits below 2 x 2.
DiagramGrid fit_diagram(const DiskDensity& density, Azimuth azimuth, const FitLimits& limits = {});

/// Lines for several diagrams: `across` and `along` are indices into a finer reference grid, on which
/// the densities are fitted.
struct SharedLines {
  Azimuth azimuth;
  std::vector<double> phi, r;              ///< the reference grid
  std::vector<std::size_t> across, along;  ///< the lines among them, first and last included
};

/// Steps 1 and 2 of fit_diagram() for several densities at once, prepared for any tolerance: the lines that
/// serve all of them best, by the sum of their errors, each relative to its own density.
/// Thread safety: immutable; concurrent use is safe.
class LineFit {
 public:
  /// Densities of 0 everywhere are left out. @throws Error for sizes below 2 x 2, or if all are 0.
  LineFit(const std::vector<DiskDensity>& densities, Azimuth azimuth, int most_meridians, int most_parallels);
  ~LineFit();
  LineFit(LineFit&&) noexcept;

  /// The smallest M x N for which step 3 leaves no density a relative variance above `tolerance`; the
  /// largest there is if none does.
  SharedLines lines(double tolerance) const;

 private:
  struct Prepared;
  std::unique_ptr<const Prepared> prepared_;
};

/// Step 3 of fit_diagram() on given lines.
DiagramGrid fit_diagram(const DiskDensity& density, const SharedLines& lines);

}  // namespace gonio
