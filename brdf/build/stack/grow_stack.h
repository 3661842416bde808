#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <gonio/brdf/build/stack/diagram_recipe.h>

namespace gonio::detail {

/// What ends the growth of a stack, whichever comes first.
struct GrowthLimits {
  std::size_t start;                                                ///< incident angles to begin with, evenly spaced
  std::size_t incident;                                             ///< incident angles
  std::size_t bytes;                                                ///< memory, beyond that of the first diagrams
  double tolerance;                                                 ///< relative variance, at and between all angles
  std::function<std::size_t(const Diagram<double>&)> bytes_of;      ///< what a diagram will take when it is sampled
  std::function<double(double)> weight = [](double) { return 1; };  ///< of the relative variance at theta_i
};

struct Grown {
  StackGrid grid;
  double mean_error;  ///< weighted mean over the angles of the estimates of relvar
  bool out_of_bytes;  ///< the tolerance was not reached for that
};

/// The diagrams of a stack, at the incident angles where the interpolation between their neighbours fails,
/// measured by the relative variance at three angles between them. For a blend, angles at which the table
/// itself has values are preferred. Deterministic; uses all cores.
Grown grow_stack(const Recipe& recipe, Interpolation interpolation, const GrowthLimits& limits,
                 const Progress& progress);

}  // namespace gonio::detail
