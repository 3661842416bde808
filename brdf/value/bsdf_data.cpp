#include <string>

#include <gonio/brdf/value/bsdf_data.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/stack/packed_stack.h>

namespace gonio {

Stack<float> sampled_stack(const BsdfData& data) {
  if (data.storage == Storage::float32) return Stack<float>(data.diagrams, data.interpolation);
  if (data.interpolation != Interpolation::blend)
    throw Error(std::string("stack: interpolation: found ") + to_string(data.interpolation) +
                ", expected blend, the only one of packed16");
  return Stack<float>(PackedStack(data.diagrams).grid(), Interpolation::blend);
}

Colour sampled_colour(const BsdfData& data, bool has_table) {
  if (has_table) return {};
  if (data.colour.empty()) throw Error("BSDF: f_r: found neither a table nor a colour, expected one of them");
  return data.colour;
}

}  // namespace gonio
