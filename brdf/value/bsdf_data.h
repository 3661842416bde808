#pragma once

#include <gonio/brdf/value/colour.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {

/// How precisely the densities of a BSDF are held.
enum class Storage {
  packed16,  ///< 16 bits a crossing, see PackedStack; Interpolation::blend alone
  float32
};

inline constexpr Storage storages[] = {Storage::packed16, Storage::float32};
inline const char* to_string(Storage storage) noexcept { return storage == Storage::packed16 ? "packed16" : "float32"; }

/// A BSDF as data: what a stack file holds and a Bsdf is made of.
struct BsdfData {
  StackGrid diagrams;  ///< with their chart
  Interpolation interpolation = Interpolation::blend;
  Storage storage = Storage::packed16;
  Colour colour;  ///< empty: f_r is that of a table
};

/// The diagrams as they are sampled, in floats: rounded to 16 bits first where they are stored so.
/// @throws Error as Stack and PackedStack do, and for packed16 with another interpolation than blend.
Stack<float> sampled_stack(const BsdfData& data);

/// The colours that f_r is computed from: those of `data`, or none where a table gives f_r.
/// @throws Error where there is neither a table nor a colour.
Colour sampled_colour(const BsdfData& data, bool has_table);

}  // namespace gonio
