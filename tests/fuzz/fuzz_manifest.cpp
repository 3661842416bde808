#include <cmath>
#include <cstdlib>

#include <gonio/mapping/base/error.h>

#include "tests/fuzz/memory_file.h"
#include "tools/convert/scene_manifest.h"

// Bytes to the manifest of `convert --scene`: shares that add up to 1. (Its files are looked for, not read.)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    double sum = 0;
    for (const gonio::SceneMaterial& material : gonio::load_scene(gonio::fuzz::memory_file(data, size)))
      sum += material.share;
    if (!(std::abs(sum - 1) < 1e-9)) std::abort();
  } catch (const gonio::Error&) {
  }
  return 0;
}
