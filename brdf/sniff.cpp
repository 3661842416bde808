#include <gonio/brdf/bytes.h>
#include <gonio/brdf/sniff.h>

#include <cstdint>
#include <cstring>

namespace gonio {
namespace {

bool starts_with(const std::string& bytes, const std::string& prefix) {
  return bytes.compare(0, prefix.size(), prefix) == 0;
}

// MERL has no magic: its three dimensions, or a size that only such a file has, give it away.
bool resembles_merl(const std::string& head, std::uintmax_t size) {
  constexpr std::uintmax_t size_180 = 12 + 3ull * 90 * 90 * 180 * 8, size_360 = 2 * size_180 - 12;
  if (head.size() < 12) return false;
  std::int32_t n[3];
  std::memcpy(n, head.data(), sizeof(n));
  if (n[0] == 90 && n[1] == 90) return true;
  if (size == size_180 || size == size_360) return true;
  // The same layout with other dimensions.
  for (const std::int32_t dimension : n) {
    if (dimension < 1 || dimension > 4096) return false;
  }
  return size == 12 + 24ull * static_cast<std::uint64_t>(n[0]) * n[1] * n[2];
}

}  // namespace

TableFormat sniff_format(const std::filesystem::path& path) {
  const std::string head = read_bytes(path, 64);
  if (starts_with(head, "tensor_file")) return TableFormat::rgl;
  if (starts_with(head, "NVIDIA ARC MBSDF")) return TableFormat::mbsdf;
  return resembles_merl(head, regular_file_size(path)) ? TableFormat::merl : TableFormat::unknown;
}

Problem unknown_format(const std::filesystem::path& path) {
  const std::string head = read_bytes(path, 16);
  std::string shown;
  for (const char c : head) shown += c >= 0x20 && c < 0x7f ? c : '.';
  return {"format", head.empty() ? "an empty file" : "a file that starts with \"" + shown + "\"",
          "MERL (int32 90 90 180), RGL (\"tensor_file\") or MBSDF (\"NVIDIA ARC MBSDF V1\")", true};
}

}  // namespace gonio
