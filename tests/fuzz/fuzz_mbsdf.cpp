#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/mapping/base/error.h>

#include "tests/fuzz/evaluate.h"

// Bytes to an MBSDF file; what is usable is made a table and evaluated.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gonio::Problems problems;
  const gonio::MbsdfFile file = gonio::parse_mbsdf(std::string(reinterpret_cast<const char*>(data), size), problems);
  if (!gonio::fuzz::usable(problems)) return 0;
  try {
    gonio::fuzz::evaluate(gonio::MbsdfTable(file));
  } catch (const gonio::Error&) {
  }
  return 0;
}
