#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <gonio/brdf/value/bsdf_data.h>

namespace gonio {

/// Where f_r of a BSDF comes from.
enum class BsdfValue {
  table,  ///< the table, exactly; it stays in memory
  colour  ///< colours of its own, fitted to the table
};

/// How often a material is seen from each angle: shares over equal bins of theta_i in [0, pi/2]; empty: all alike.
using Incidence = std::vector<double>;

/// What a BSDF is made for. Growth ends where the variance, the bytes or a size is reached, whichever comes first.
struct BsdfOptions {
  BsdfValue f_r = BsdfValue::table;
  std::optional<Chart> chart;  ///< none: of a blend the one that takes fewer bytes, otherwise outgoing
  Interpolation interpolation = Interpolation::blend;
  /// The relative variance of sampling that is good enough, at and between all incident angles up to 80 degrees. None:
  /// the least error of f_r within the budget.
  std::optional<double> max_variance = 0.003;
  std::size_t budget = 256 * 1024;  ///< bytes at most, as Bsdf holds them
  Incidence incidence;              ///< where the error counts; `max_variance` holds at every angle all the same
  int incident = 192;               ///< incident angles at most, >= 2
  int meridians = 64;               ///< in a diagram at most, >= 2
  int parallels = 48;               ///< in a diagram at most, >= 2
};

}  // namespace gonio
