#include <cmath>
#include <cstdlib>

#include <gonio/fitting/model/model.h>
#include <gonio/mapping/base/error.h>

// Bytes to a fit.json: what loads has lobes, is written and read back the same, and reflects no less than nothing.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gonio;
  try {
    const LobeModel model = model_from_json({reinterpret_cast<const char*>(data), size}, "fuzz");
    if (model.lobes.empty()) std::abort();
    if (describe(model_from_json(to_json(model), "again")) != describe(model)) std::abort();
    const glm::dvec3 f = model.eval(glm::vec3(0.6f, 0, 0.8f), glm::vec3(-0.48f, 0.36f, 0.8f));
    for (int c = 0; c < 3; ++c)
      if (!(f[c] >= 0)) std::abort();
  } catch (const Error&) {
  }
  return 0;
}
