#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gonio/mapping/base/problem.h>

namespace gonio {

/// The container of the RGL material files: named arrays. Holds the bytes of the file.
class TensorFile {
 public:
  enum class Type : std::uint8_t { u8 = 1, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64 };

  struct Field {
    std::string name;
    Type type;
    std::vector<std::uint64_t> shape;
    std::size_t offset;  ///< of the first value, in bytes from the start of the file
    std::size_t count;   ///< product of the shape
  };

  /// Reads the list of fields. Damaged fields are left out and reported in `problems`. A file that is
  /// cut off has no fields, and one problem that says how long it should be.
  TensorFile(std::string bytes, Problems& problems);

  /// Null if there is no such field.
  const Field* find(const std::string& name) const noexcept;

  std::vector<float> floats(const Field& field) const;         ///< field.type must be f32
  std::vector<std::uint8_t> octets(const Field& field) const;  ///< field.type must be u8

 private:
  std::string bytes_;
  std::vector<Field> fields_;
};

/// "f32 [8, 32, 32]"
std::string to_string(const TensorFile::Field& field);

}  // namespace gonio
