#include <cstdlib>

#include <gonio/brdf/formats/merl.h>

// Bytes to a MERL file: nothing but problems may come of it, and a usable one holds all its cells.
// (Tables are not made of it: that takes 34 MB of bytes, which no fuzzer writes.)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gonio::Problems problems;
  const gonio::MerlFile file = gonio::parse_merl(std::string(reinterpret_cast<const char*>(data), size), problems);
  if (!file.values.empty() && file.values.size() != 3 * file.cells()) std::abort();
  if (file.values.empty() && problems.empty()) std::abort();
  return 0;
}
