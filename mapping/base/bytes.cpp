#include <algorithm>
#include <fstream>
#include <string_view>

#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

// What Git leaves in place of a file that it has not fetched.
constexpr std::string_view lfs_pointer = "version https://git-lfs.github.com/spec/";

}  // namespace

std::uintmax_t regular_file_size(const std::filesystem::path& path) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (status.type() == std::filesystem::file_type::not_found) throw Error(path.string() + ": no such file");
  if (status.type() == std::filesystem::file_type::none) throw Error(path.string() + ": " + code.message());
  if (status.type() != std::filesystem::file_type::regular) {
    const bool folder = status.type() == std::filesystem::file_type::directory;
    throw Error(path.string() + ": found " + (folder ? "a folder" : "a pipe or a device") + ", expected a file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) throw Error(path.string() + ": size: " + code.message());
  return size;
}

std::string read_bytes(const std::filesystem::path& path, std::uintmax_t limit) {
  // Even the first four bytes of a pointer are not those of the file.
  const std::uintmax_t size = std::min(regular_file_size(path), std::max<std::uintmax_t>(limit, lfs_pointer.size()));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(path.string() + ": cannot be opened for reading");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw Error(path.string() + ": content: found " + std::to_string(stream.gcount()) + " bytes, expected " +
                std::to_string(size));
  }
  if (bytes.compare(0, lfs_pointer.size(), lfs_pointer) == 0)
    throw Error(path.string() + ": found a Git LFS pointer in place of the file; git lfs pull fetches it");
  if (bytes.size() > limit) bytes.resize(static_cast<std::size_t>(limit));
  return bytes;
}

bool begins_as_exr(std::string_view bytes) noexcept { return bytes.substr(0, 4) == "\x76\x2f\x31\x01"; }

bool begins_as_utf16(std::string_view bytes) noexcept {
  return bytes.substr(0, 2) == "\xff\xfe" || bytes.substr(0, 2) == "\xfe\xff";
}

}  // namespace gonio
