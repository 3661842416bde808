#pragma once

#include <gonio/brdf/value/colour.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// A BSDF as data: what a stack file holds and a Bsdf is made of.
struct BsdfData {
  StackGrid diagrams;  ///< with their chart
  Interpolation interpolation = Interpolation::blend;
  Colour colour;  ///< empty: f_r is that of a table
};

/// The diagrams as they are sampled: rounded16(), in floats. @throws Error as Stack and rounded16() do.
Stack<float> sampled_stack(const BsdfData& data);

/// The colours that f_r is computed from: those of `data`, or none where a table gives f_r.
/// @throws Error where there is neither a table nor a colour.
Colour sampled_colour(const BsdfData& data, bool has_table);

}  // namespace gonio
