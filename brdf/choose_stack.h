#pragma once

#include <vector>

#include <gonio/brdf/build.h>

namespace gonio {

/// A stack and how good it is.
struct RatedStack {
  StackGrid grid;
  Interpolation interpolation;
  double relvar;  ///< mean over rating_angles
};

/// Incident angles at which stacks are rated [degrees].
inline constexpr double rating_angles[] = {2, 10, 30, 50, 70, 80};

/// Mean over rating_angles of the relative variance of sampling the table by the stack, on a jittered
/// 128 x 128 grid of (u, v). Deterministic.
double rate_stack(const BrdfTable& table, const Stack<float>& stack);

/// Builds a stack for every candidate, at the same limits, and rates it. Best first.
/// @param candidates options of build_stack(), at least one.
std::vector<RatedStack> choose_stack(const BrdfTable& table, const std::vector<StackOptions>& candidates,
                                     const Progress& progress = {});

}  // namespace gonio
