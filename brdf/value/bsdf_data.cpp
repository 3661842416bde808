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

}  // namespace gonio
