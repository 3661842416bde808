#include <gonio/brdf/ndf/image/disk_image_file.h>
#include <gonio/mapping/base/error.h>

#include "tests/fuzz/memory_file.h"

// Bytes to the image of a normal distribution.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    gonio::load_ndf_image(gonio::fuzz::memory_file(data, size));
  } catch (const gonio::Error&) {
  }
  return 0;
}
