#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

namespace gonio {

// Every binary format is little-endian and is read and written by copying bytes.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "gonio reads tables on little-endian only");

/// Size in bytes of a regular file. @throws Error if there is no such file or it is not regular.
std::uintmax_t regular_file_size(const std::filesystem::path& path);

/// The first `limit` bytes of a regular file, or all of it if it is shorter. Every file that is read as bytes
/// comes through here. @throws Error if the file cannot be read, or is a Git LFS pointer
std::string read_bytes(const std::filesystem::path& path, std::uintmax_t limit = UINTMAX_MAX);

/// True for the magic number of OpenEXR.
bool begins_as_exr(std::string_view bytes) noexcept;

/// True for a mark of the byte order of UTF-16.
bool begins_as_utf16(std::string_view bytes) noexcept;

/// Cursor over a block of bytes that refuses to pass its end. Does not own the bytes.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}

  std::size_t position() const noexcept { return position_; }
  std::size_t remaining() const noexcept { return bytes_.size() - position_; }

  /// Copies `count` values and moves on; returns false, and stays, if fewer remain.
  template <class T>
  bool read(T* values, std::size_t count) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > remaining() / sizeof(T)) return false;
    if (count > 0) std::memcpy(values, bytes_.data() + position_, count * sizeof(T));
    position_ += count * sizeof(T);
    return true;
  }

  template <class T>
  bool read(T& value) noexcept {
    return read(&value, 1);
  }

  bool skip(std::size_t count) noexcept {
    if (count > remaining()) return false;
    position_ += count;
    return true;
  }

 private:
  const std::string& bytes_;
  std::size_t position_ = 0;
};

}  // namespace gonio
