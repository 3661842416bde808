#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/stability/variants.h"

namespace gonio {

/// How one variant does on one input.
struct StabilityRow {
  std::string variant, input, error_of, why;
  double max_error;       ///< [float ulp]
  double bound;           ///< of max_error
  double bias;            ///< of the estimate of an integral, relative
  double standard_error;  ///< of bias
  double chi2_p;          ///< of the draws against the pdf claimed
  std::uint64_t lost;     ///< draws that are not finite, below the horizon or where the pdf is 0
  bool error_fails, bias_fails, chi2_fails;

  bool fails() const { return error_fails || bias_fails || chi2_fails; }
  bool library() const { return variant.rfind("gonio-", 0) == 0; }
};

/// All variants of an input. `rows` is the number of rows of the study: chi-square fails below
/// 1 - (1 - 0.01)^(1/rows) (Sidak). Every row draws its own random numbers, from `seed` on.
std::vector<StabilityRow> measure_input(const StabilityInput& input, int rows, std::uint32_t seed);

}  // namespace gonio
