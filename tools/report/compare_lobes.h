#pragma once

#include <iosfwd>

#include "tools/report/measure/report_data.h"

namespace gonio {

/// What fitted lobes cost as samplers of the table, beside stacks. Relative variances are means
/// over the report's angles up to 70 degrees.
struct LobeComparison {
  /// The fewest lobes that are enough; if none are, those with the least time x variance.
  std::string lobes;
  double samples = 0;      ///< its variance over that of `displacement`
  double equal_time = 0;   ///< its time x variance over that of `displacement`
  double equal_bytes = 0;  ///< its variance over that of `displacement_small`
  bool enough = false;     ///< equal_time <= lobes_enough_factor, or variance <= lobes_enough_relvar
};

/// Fitted lobes are called enough if, at equal time, they have at most this many times the variance
/// of a stack.
inline constexpr double lobes_enough_factor = 2;

/// And they are called enough whatever the stack reaches if their relative variance is this small:
/// light that varies over the hemisphere adds more.
inline constexpr double lobes_enough_relvar = 0.01;

/// Over the report's angles up to 70 degrees.
double mean_relvar(const MethodReport& method);

/// Empty without both kinds of methods (a stack file has no lobes).
std::optional<LobeComparison> compare_lobes(const MaterialReport& material);

nlohmann::json to_json(const LobeComparison& comparison);

/// The sentence that says it, and the fits with their errors; nothing without fits.
void write_lobes(std::ostream& out, const MaterialReport& material);

}  // namespace gonio
