#include <algorithm>
#include <cstring>

#include <gonio/brdf/formats/rgl/tensor_file.h>
#include <gonio/mapping/base/bytes.h>

namespace gonio {
namespace {

constexpr char magic[] = "tensor_file";  // 12 bytes with its 0
constexpr std::size_t type_size[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
constexpr const char* type_name[] = {"", "u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f16", "f32", "f64"};
constexpr std::uint16_t max_dimensions = 16;

// No file is larger; a field that would end beyond is damaged, not cut off.
constexpr std::uint64_t max_bytes = std::uint64_t{1} << 48;

// Number of values, or false if they are more than `limit` (which also covers overflow).
bool count_values(const std::vector<std::uint64_t>& shape, std::uint64_t limit, std::size_t& count) {
  std::uint64_t product = 1;
  for (const std::uint64_t n : shape) {
    if (n != 0 && product > limit / n) return false;
    product *= n;
  }
  count = static_cast<std::size_t>(product);
  return true;
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text = "[";
  for (const std::uint64_t n : shape) text += (text.size() > 1 ? ", " : "") + std::to_string(n);
  return text + "]";
}

}  // namespace

TensorFile::TensorFile(std::string bytes, Problems& problems) : bytes_(std::move(bytes)) {
  ByteReader reader(bytes_);
  char found_magic[sizeof(magic)];
  std::uint8_t version[2];
  std::uint32_t n_fields;
  if (!reader.read(found_magic, sizeof(magic)) || std::memcmp(found_magic, magic, sizeof(magic)) != 0) {
    problems.push_back({"magic", "something else", "\"tensor_file\"", true});
    return;
  }
  if (!reader.read(version, 2) || !reader.read(n_fields)) {
    problems.push_back({"header", std::to_string(bytes_.size()) + " bytes", "18 bytes", true});
    return;
  }
  if (version[0] != 1) {
    problems.push_back(
        {"container version", std::to_string(version[0]) + "." + std::to_string(version[1]), "1.0", true});
    return;
  }
  std::uint64_t needed = 0;  // bytes, to the end of the field that ends last
  std::string last;
  for (std::uint32_t i = 0; i < n_fields; ++i) {
    const std::string which = "field " + std::to_string(i + 1) + " of " + std::to_string(n_fields);
    Field field{};
    std::uint16_t name_length = 0, n_dimensions = 0;
    std::uint8_t type = 0;
    std::uint64_t offset = 0;
    bool complete = reader.read(name_length);
    if (complete) {
      field.name.resize(name_length);
      complete = reader.read(field.name.data(), name_length) && reader.read(n_dimensions) && reader.read(type) &&
                 reader.read(offset);
    }
    if (complete && n_dimensions > max_dimensions) {
      problems.push_back({which + " (" + field.name + ")", std::to_string(n_dimensions) + " dimensions",
                          "at most " + std::to_string(max_dimensions), true});
      fields_.clear();  // whether they lie within the file is not known yet
      return;
    }
    if (complete) {
      field.shape.resize(n_dimensions);
      complete = reader.read(field.shape.data(), n_dimensions);
    }
    if (!complete) {
      problems.push_back({which, "the end of the file after " + std::to_string(bytes_.size()) + " bytes",
                          "its name, type, offset and shape: the file is cut off", true});
      fields_.clear();
      return;
    }
    if (type < 1 || type > 11) {
      problems.push_back({field.name + " type", std::to_string(type), "1 to 11", true});
      continue;
    }
    field.type = static_cast<Type>(type);
    if (offset > max_bytes || !count_values(field.shape, (max_bytes - offset) / type_size[type], field.count)) {
      problems.push_back({field.name,
                          "shape " + shape_text(field.shape) + " of " + type_name[type] + " at byte " +
                              std::to_string(offset) + " of " + std::to_string(bytes_.size()),
                          "values that lie within the file", true});
      continue;
    }
    field.offset = static_cast<std::size_t>(offset);
    if (const std::uint64_t end = offset + field.count * type_size[type]; end > needed) {
      needed = end;
      last = field.name;
    }
    if (find(field.name) != nullptr) {
      problems.push_back({field.name, "a second field of this name", "one", true});
      continue;
    }
    fields_.push_back(std::move(field));
  }
  if (needed > bytes_.size()) {
    // What follows from it would only hide it.
    problems.insert(problems.begin(), {"size", "a file of " + std::to_string(bytes_.size()) + " bytes, cut off",
                                       std::to_string(needed) + " bytes, where " + last + " ends", true});
    fields_.clear();
  }
}

const TensorFile::Field* TensorFile::find(const std::string& name) const noexcept {
  const auto it = std::find_if(fields_.begin(), fields_.end(), [&](const Field& field) { return field.name == name; });
  return it == fields_.end() ? nullptr : &*it;
}

std::vector<float> TensorFile::floats(const Field& field) const {
  std::vector<float> values(field.count);
  if (field.count > 0) {
    std::memcpy(values.data(), bytes_.data() + field.offset, field.count * sizeof(float));
  }
  return values;
}

std::vector<std::uint8_t> TensorFile::octets(const Field& field) const {
  const char* begin = bytes_.data() + field.offset;
  return std::vector<std::uint8_t>(begin, begin + field.count);
}

std::string to_string(const TensorFile::Field& field) {
  return std::string(type_name[static_cast<int>(field.type)]) + " " + shape_text(field.shape);
}

}  // namespace gonio
