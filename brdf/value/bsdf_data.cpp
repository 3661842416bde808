#include <gonio/brdf/value/bsdf_data.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/stack/rounded16.h>

namespace gonio {

Stack<float> sampled_stack(const BsdfData& data) { return Stack<float>(rounded16(data.diagrams), data.interpolation); }

Colour sampled_colour(const BsdfData& data, bool has_table) {
  if (has_table) return {};
  if (data.colour.empty()) throw Error("BSDF: f_r: found neither a table nor a colour, expected one of them");
  return data.colour;
}

}  // namespace gonio
