#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/mapping/base/error.h>

#include "tests/fuzz/evaluate.h"

// Bytes to an RGL file; what is usable is made a table, evaluated and sampled.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gonio::Problems problems;
  gonio::RglFile file = gonio::parse_rgl(std::string(reinterpret_cast<const char*>(data), size), problems);
  if (!gonio::fuzz::usable(problems)) return 0;
  try {
    const gonio::RglTable table(std::move(file), {});
    gonio::fuzz::evaluate(table);
    for (const float u : {0.0f, 0.5f, 1 - 0x1p-24f}) {
      const auto s = table.sample(gonio::fuzz::direction(0.6f, 0), u, 1 - u);
      if (s && !(s->pdf >= 0)) std::abort();
    }
  } catch (const gonio::Error&) {
  }
  return 0;
}
