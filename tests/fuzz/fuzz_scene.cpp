#include <cmath>
#include <cstdlib>

#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/error.h>

#include "tools/render/scene/read_scene.h"

// Bytes to a scene of `gonio render`: what loads has objects, whose corners are numbers. (It names files
// of a folder that is empty.)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gonio;
  try {
    const Scene scene =
        make_scene(parse_json({reinterpret_cast<const char*>(data), size}, "fuzz"), "fuzz", "/nonexistent");
    if (scene.objects.empty()) std::abort();
    for (const Object& object : scene.objects) {
      if (object.material >= scene.materials.size()) std::abort();
      for (const glm::vec3& p : object.mesh->positions)
        for (int c = 0; c < 3; ++c)
          if (!std::isfinite(p[c])) std::abort();
    }
  } catch (const Error&) {
  }
  return 0;
}
