#include "tests/fuzz/mesh.h"

// Bytes to a mesh; the corpus is of OBJ files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gonio::fuzz::mesh(data, size);
  return 0;
}
