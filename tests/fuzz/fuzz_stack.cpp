#include <gonio/brdf/exr/stack_file.h>
#include <gonio/mapping/base/error.h>

#include "tests/fuzz/memory_file.h"

namespace {

template <class S>
void draw(const S& map) {
  for (const float theta_i : {0.0f, 0.7f, 1.57f})
    for (const float u : {0.0f, 0.3f, 1 - 0x1p-24f}) {
      const auto s = map.sample(theta_i, u, 1 - u);
      if (!(s.pdf >= 0 && s.wo.z > 0)) std::abort();
      if (!(map.pdf(theta_i, s.wo) >= 0)) std::abort();
    }
}

}  // namespace

// Bytes to a stack file; what loads is sampled.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const gonio::StackFile file = gonio::load_stack(gonio::fuzz::memory_file(data, size));
    draw(gonio::sampled_stack(file.bsdf));
  } catch (const gonio::Error&) {
  }
  return 0;
}
