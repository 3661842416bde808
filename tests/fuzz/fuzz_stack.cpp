#include <gonio/brdf/exr/stack_file.h>
#include <gonio/mapping/error.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

// Bytes to a stack file; what loads is sampled. OpenEXR reads files only: one in memory.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("stack", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  try {
    const gonio::StackFile stack = gonio::load_stack(path);
    const gonio::Stack<float> map(stack.diagrams, gonio::Interpolation::displacement);
    for (const float theta_i : {0.0f, 0.7f, 1.57f})
      for (const float u : {0.0f, 0.3f, 1 - 0x1p-24f}) {
        const auto s = map.sample(theta_i, u, 1 - u);
        if (!(s.pdf >= 0 && s.wo.z > 0)) std::abort();
        if (!(map.pdf(theta_i, s.wo) >= 0)) std::abort();
      }
  } catch (const gonio::Error&) {
  }
  return 0;
}
