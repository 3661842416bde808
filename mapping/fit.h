#pragma once

#include <functional>

#include <gonio/mapping/diagram.h>

namespace gonio {

/// Chooses lines and densities of a diagram from a density function, so that the bilinear diagram
/// is as close to it as its size allows, in the sense that decides sampling quality: the chi-square
/// divergence, which is the relative variance of the estimate.
///
/// 1. The function is tabulated on a reference grid, about five times finer per axis than the
///    diagram, whose lines move to where it bends (two rounds).
/// 2. Of the reference lines those are kept, per axis, that minimise the summed squared error of
///    linear interpolation relative to the density: an exact optimum by dynamic programming.
/// 3. The densities at the crossings are fitted by Richardson-Lucy (EM) steps, which keep them
///    positive, conserve the mass and descend on the divergence. Interpolating the function at the
///    crossings would leave several times its variance. The pole is one value for all meridians.
///
/// @param density the density at (r, phi) [any scale], finite and >= 0; phi in [0, pi] or [0, 2 pi).
///   Called from one thread, some 10^5 times. Non-finite or negative values count as 0.
/// @param meridians, parallels the size M >= 2, N >= 2 of the diagram.
/// @return a grid with the scale of `density`; a function that is 0 everywhere gives zeros.
/// @throws Error for a size below 2 x 2.
DiagramGrid fit_diagram(const std::function<double(Polar<double>)>& density, Azimuth azimuth,
                        int meridians, int parallels);

}  // namespace gonio
