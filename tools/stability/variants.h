#pragma once

#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/proof/statistics/bins.h>

#include "tools/stability/inputs.h"

namespace gonio {

/// One way to sample an input, complete from the unit square to the direction. Textbook variants differ
/// from the library in the one step that they are named after.
struct Variant {
  /// A direction (not finite if a formula broke down) and the pdf claimed for it [1/sr].
  struct Draw {
    glm::vec3 wo;
    double pdf;
  };

  std::string name;
  std::string error_of;  ///< what `error` is the error of
  double bound;          ///< the largest error allowed [ulp]
  std::string why;       ///< why it fails, or why it does not
  std::function<Draw(float u, float v)> sample;
  std::function<double(const glm::vec3&)> pdf;    ///< the pdf that it claims to have [1/sr]
  std::function<double(const glm::vec3&)> value;  ///< what an estimate divides by the pdf of a draw
  /// The error of the draw of (u, v) against long double [float ulp].
  std::function<double(float u, float v)> error;
};

/// All variants of an input, textbook and library. The functions own what they use.
std::vector<Variant> make_variants(const StabilityInput& input);

/// The names of the variants, in the same order.
std::vector<std::string> variant_names();

/// An error this large [ulp] is an answer without a correct digit, which includes NaN.
inline constexpr double no_digit = 8388608;

}  // namespace gonio
