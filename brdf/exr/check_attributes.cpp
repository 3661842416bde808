#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>

#include <gonio/brdf/exr/check_attributes.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& field, const std::string& found,
                       const std::string& expected) {
  throw Error(file + ": " + field + ": found " + found + ", expected " + expected);
}

/// Bytes that OpenEXR reads for a type whatever the size that the file gives; 0 for other types.
std::size_t fixed_size(const std::string& type) {
  static const std::map<std::string, std::size_t> sizes{{"box2f", 16},
                                                        {"box2i", 16},
                                                        {"chromaticities", 32},
                                                        {"compression", 1},
                                                        {"deepImageState", 1},
                                                        {"double", 8},
                                                        {"envmap", 1},
                                                        {"float", 4},
                                                        {"int", 4},
                                                        {"keycode", 28},
                                                        {"lineOrder", 1},
                                                        {"m33f", 36},
                                                        {"m33d", 72},
                                                        {"m44f", 64},
                                                        {"m44d", 128},
                                                        {"rational", 8},
                                                        {"tiledesc", 9},
                                                        {"timecode", 8},
                                                        {"v2f", 8},
                                                        {"v2i", 8},
                                                        {"v2d", 16},
                                                        {"v3f", 12},
                                                        {"v3i", 12},
                                                        {"v3d", 24}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

}  // namespace

void check_attribute_sizes(const std::string& file) {
  const std::string bytes = read_bytes(file);
  const auto end_of_text = [&](std::size_t at) { return bytes.find('\0', at); };
  std::size_t at = 8;  // magic number, version
  while (at < bytes.size()) {
    if (bytes[at] == '\0') {  // the end of a header; in a multi-part file (a flag of the version), another may follow
      if ((bytes[5] & 0x10) == 0) return;
      if (++at >= bytes.size() || bytes[at] == '\0') return;
      continue;
    }
    const std::size_t name = end_of_text(at);
    const std::size_t type = name == std::string::npos ? name : end_of_text(name + 1);
    std::int32_t size = 0;
    if (type == std::string::npos || bytes.size() - type < 1 + sizeof(size)) return;
    std::memcpy(&size, bytes.data() + type + 1, sizeof(size));
    const std::size_t first = type + 1 + sizeof(size);
    if (size < 0 || static_cast<std::size_t>(size) > bytes.size() - first)
      fail(file, "attribute " + bytes.substr(at, std::min<std::size_t>(name - at, 64)), std::to_string(size) + " bytes",
           "at most the " + std::to_string(bytes.size() - first) + " that follow");
    const std::size_t fixed = fixed_size(bytes.substr(name + 1, type - name - 1));
    if (fixed != 0 && static_cast<std::size_t>(size) != fixed)
      fail(file, "attribute " + bytes.substr(at, std::min<std::size_t>(name - at, 64)), std::to_string(size) + " bytes",
           std::to_string(fixed) + " for its type");
    at = first + static_cast<std::size_t>(size);
  }
}

}  // namespace gonio
