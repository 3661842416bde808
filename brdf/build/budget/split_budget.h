#pragma once

#include <cstddef>
#include <vector>

namespace gonio {

/// What a material may be: a size, and the variance that comes with it.
struct BudgetPoint {
  std::size_t bytes;
  double variance;  ///< expected relative variance of a sample, >= 0
};

/// Chooses one point of every curve such that their bytes add up to at most `bytes` and the sum of
/// weight x variance is small: starting with the smallest points, takes the step that lowers the sum
/// most per byte, among those that still fit, until none does.
///
/// That follows the lower convex hulls of the curves as long as everything fits (Shoham and Gersho,
/// Efficient Bit Allocation for an Arbitrary Set of Quantizers, 1988): up to there the result is optimal for
/// the bytes that it takes, and in the end no worse than the optimum by more than what the first step
/// that did not fit would have gained. Deterministic; O(M P (P + log M)) for M curves of P points.
///
/// @param curves  one per material, each at least one point, in any order
/// @param weights one per material, >= 0, such as its share of the shaded points
/// @param bytes   the total
/// @return the index of the chosen point of every curve
/// @throws Error for an empty curve, weights or variances that are negative or not finite, and if
///   even the smallest points take more than `bytes`; the message says how many they take.
std::vector<std::size_t> split_budget(const std::vector<std::vector<BudgetPoint>>& curves,
                                      const std::vector<double>& weights, std::size_t bytes);

}  // namespace gonio
