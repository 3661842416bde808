#pragma once

#include <cstdint>
#include <vector>

#include <gonio/brdf/proof/measure.h>

namespace gonio::proof {

/// Whether neighbouring (u, v) go to neighbouring directions.
struct Coherence {
  /// Distribution of the stretch of small cells of the square: the longest side of the image of a cell
  /// over that of a square of the solid angle that the pdf gives the cell. 1 keeps shapes; long, thin
  /// images have more. Draws that are stratified in the square are as well spread on the hemisphere
  /// as this is small.
  double stretch_p50 = 0, stretch_p99 = 0, stretch_worst = 0;
  /// Sides of cells whose ends stay apart however near they are moved to each other (to 1/4096 of a side).
  std::uint64_t tears = 0;
  /// Cells whose image is turned inside out.
  std::uint64_t folds = 0;
};

/// Looks at side x side cells of the unit square at incident angle theta_i [rad]. Cells with a corner
/// that has no direction are left out. A map that spends less than 1/(4096 side) of the square on a
/// region counts as torn there: a float cannot tell it from one.
Coherence measure_coherence(const Subject& subject, double theta_i, int side = 64);

/// How fast the error of the reflected radiance of a smooth environment falls with the number of
/// samples, N = 2^4, 2^5 ... 2^last.
struct Convergence {
  std::vector<double> qmc_error, mc_error;  ///< relative standard error at each N
  double qmc_slope = 0, mc_slope = 0;       ///< of log(error) against log(N), least squares; -0.5 is random
};

/// Estimates the luminance that the subject reflects from the environment 1 + x/2 + y/4 + z^2 (over
/// the direction's components) with scrambled Sobol' points and with random numbers; errors are
/// standard deviations over 16 independent repeats. @param last in [5, 20].
/// Deterministic for a seed. All zero for a subject that reflects nothing.
Convergence measure_convergence(const Subject& subject, double theta_i, int last = 16, std::uint32_t seed = 1);

/// Point k of the two-dimensional Sobol' sequence (the first dimension is van der Corput's), with a
/// random digital shift (Kollig and Keller 2002): each in [0, 1) with 24 bits. Any k, any shift.
glm::vec2 sobol(std::uint32_t k, std::uint32_t shift_u, std::uint32_t shift_v) noexcept;

}  // namespace gonio::proof
