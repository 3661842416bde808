#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace gonio {

/// The container of the RGL material files, for writing: what TensorFile reads.
class TensorWriter {
 public:
  /// An array of floats; `values` has the product of the shape.
  void add(const std::string& name, std::vector<std::uint64_t> shape, const std::vector<float>& values);
  /// Text or flags: octets of one dimension.
  void add(const std::string& name, const std::string& octets);

  /// The header, then the values, each field's at a multiple of 8: some readers map the file.
  void write(std::ostream& stream) const;

 private:
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::uint64_t> shape;
    std::string bytes;
  };
  std::vector<Field> fields_;
};

}  // namespace gonio
