#include <gonio/brdf/bytes.h>
#include <gonio/mapping/error.h>

#include <algorithm>
#include <fstream>

namespace gonio {

std::uintmax_t regular_file_size(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    const bool exists = std::filesystem::exists(path, code);
    throw Error(path.string() + ": found " + (exists ? "something that is not a file" : "nothing") +
                ", expected a readable file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) throw Error(path.string() + ": size: " + code.message());
  return size;
}

std::string read_bytes(const std::filesystem::path& path, std::uintmax_t limit) {
  const std::uintmax_t size = std::min(regular_file_size(path), limit);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(path.string() + ": cannot be opened for reading");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) {
    throw Error(path.string() + ": content: found " + std::to_string(stream.gcount()) +
                " bytes, expected " + std::to_string(size));
  }
  return bytes;
}

}  // namespace gonio
