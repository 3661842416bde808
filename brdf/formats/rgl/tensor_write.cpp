#include <gonio/brdf/formats/rgl/tensor_file.h>
#include <gonio/brdf/formats/rgl/tensor_write.h>

namespace gonio {
namespace {

constexpr std::size_t alignment = 8;

std::size_t aligned(std::size_t offset) { return (offset + alignment - 1) / alignment * alignment; }

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

void TensorWriter::add(const std::string& name, std::vector<std::uint64_t> shape, const std::vector<float>& values) {
  fields_.push_back({name, static_cast<std::uint8_t>(TensorFile::Type::f32), std::move(shape),
                     std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float))});
}

void TensorWriter::add(const std::string& name, const std::string& octets) {
  fields_.push_back({name, static_cast<std::uint8_t>(TensorFile::Type::u8), {octets.size()}, octets});
}

void TensorWriter::write(std::ostream& stream) const {
  std::size_t offset = 18;
  for (const Field& field : fields_) offset += 13 + field.name.size() + 8 * field.shape.size();
  std::string header("tensor_file\0\1\0", 14);
  put(header, static_cast<std::uint32_t>(fields_.size()));
  for (const Field& field : fields_) {
    offset = aligned(offset);
    put(header, static_cast<std::uint16_t>(field.name.size()));
    header += field.name;
    put(header, static_cast<std::uint16_t>(field.shape.size()));
    put(header, field.type);
    put(header, static_cast<std::uint64_t>(offset));
    for (const std::uint64_t n : field.shape) put(header, n);
    offset += field.bytes.size();
  }
  std::size_t written = header.size();
  stream << header;
  for (const Field& field : fields_) {
    stream << std::string(aligned(written) - written, '\0') << field.bytes;
    written = aligned(written) + field.bytes.size();
  }
}

}  // namespace gonio
