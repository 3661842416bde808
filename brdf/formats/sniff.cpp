#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <vector>

#include <gonio/brdf/formats/sniff.h>
#include <gonio/mapping/base/bytes.h>

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

// With a mark of the byte order, or with a 0 as every second byte.
bool is_utf16(const std::string& head) {
  if (begins_as_utf16(head)) return true;
  if (head.size() < 8) return false;
  for (std::size_t i = 0; i < 8; ++i)
    if ((head[i] == '\0') == (head[i ^ 1] == '\0')) return false;
  return (head[0] == '\0') == (head[2] == '\0') && (head[2] == '\0') == (head[4] == '\0');
}

// The Latin letters of UTF-16.
std::string without_zeros(const std::string& head) {
  std::string text = begins_as_utf16(head) ? head.substr(2) : head;
  text.erase(std::remove(text.begin(), text.end(), '\0'), text.end());
  return text;
}

bool is_number(const std::string& line, int least, int most) {
  std::istringstream stream(line);
  int value;
  std::string rest;
  return stream >> value && !(stream >> rest) && value >= least && value <= most;
}

// A line TILT=, or a first line that names the standard.
bool resembles_ies(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    std::string text;
    for (const char c : line)
      if (!std::isspace(static_cast<unsigned char>(c)))
        text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (starts_with(text, "TILT=") || (&line == &lines.front() && starts_with(text, "IESNA"))) return true;
  }
  return false;
}

// EULUMDAT has no mark: the second line is its type, then come the symmetry and the number of planes.
bool resembles_eulumdat(const std::vector<std::string>& lines) {
  return lines.size() > 4 && is_number(lines[1], 0, 3) && is_number(lines[2], 0, 4) && is_number(lines[3], 1, 721);
}

std::string luminaire_kind(const std::string& head) {
  std::istringstream stream(head);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  if (resembles_eulumdat(lines)) return "EULUMDAT";
  return !lines.empty() && resembles_ies(lines) ? "IES" : "";
}

std::string describe(const std::string& head) {
  if (head.empty()) return "an empty file";
  if (begins_as_exr(head)) return "an OpenEXR file (gonio info takes stack files)";
  const bool wide = is_utf16(head);
  if (const std::string kind = luminaire_kind(wide ? without_zeros(head) : head); !kind.empty())
    return "a luminaire, " + kind + (wide ? " in UTF-16" : "") + " (gonio light info takes it)";
  if (wide) return "UTF-16 text (iconv -f UTF-16 -t UTF-8 FILE > NEW writes it as UTF-8)";
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && head[first] == '{')
    return "a JSON file (gonio info takes fits, gonio render takes scenes)";
  std::string shown;
  for (const char c : head.substr(0, 16)) shown += c >= 0x20 && c < 0x7f ? c : '.';
  return "a file that starts with \"" + shown + "\"";
}

}  // namespace

TableFormat sniff_format(const std::filesystem::path& path) {
  const std::string head = read_bytes(path, 64);
  if (starts_with(head, "tensor_file")) return TableFormat::rgl;
  if (starts_with(head, "NVIDIA ARC MBSDF")) return TableFormat::mbsdf;
  return resembles_merl(head, regular_file_size(path)) ? TableFormat::merl : TableFormat::unknown;
}

std::string describe_file(const std::filesystem::path& path) {
  const std::string taken = " (gonio info and gonio convert take it)";
  switch (sniff_format(path)) {
    case TableFormat::merl:
      return "a measured BRDF, MERL" + taken;
    case TableFormat::rgl:
      return "a measured BRDF, RGL" + taken;
    case TableFormat::mbsdf:
      return "a measured BRDF, MBSDF" + taken;
    case TableFormat::unknown:
      break;
  }
  return describe(read_bytes(path, 4096));
}

Problem unknown_format(const std::filesystem::path& path) {
  return {"format", describe_file(path),
          "MERL (int32 90 90 180), RGL (\"tensor_file\") or MBSDF (\"NVIDIA ARC MBSDF V1\")", true};
}

}  // namespace gonio
