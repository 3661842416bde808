#pragma once

#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// A stack whose densities are 16-bit numbers (code16.h) in units of the largest of their diagram, as a Bsdf holds
/// them. The diagrams are normalised after rounding: what is stored is the truth, so that a pdf is that of its draws
/// and integrates to 1.
///
/// A density is within 2^-11 of the one given, relative, in the 29 powers of two below the largest, before the
/// normalisation, which is within 2^-11, too; a positive one stays positive. Rounding again gives the same bits.
/// @throws Error as Stack<float> with `nearest` does, and if the mass of a diagram is so small against its largest
///   density that its scale is beyond float.
StackGrid rounded16(const StackGrid& grid);

}  // namespace gonio
