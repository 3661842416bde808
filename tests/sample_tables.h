#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// Small valid files of each table format, as bytes, for tests to load, convert and damage.

namespace gonio::test {

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// A grey Lambertian MBSDF of albedo 0.5 with `n_theta` x `n_theta` x `n_phi` RGB cells.
inline std::string sample_mbsdf(std::uint32_t n_theta = 6, std::uint32_t n_phi = 8) {
  std::string bytes = "NVIDIA ARC MBSDF V1\nname=\"sample\"\nMBSDF_DATA_REFLECTION=\n";
  for (const std::uint32_t n : {1u, n_theta, n_phi}) append(bytes, n);
  for (std::uint32_t i = 0; i < 3 * n_theta * n_theta * n_phi; ++i)
    append(bytes, 0.5f / 3.14159265f);
  return bytes;
}

/// A MERL table with every value 100, and the header 90, 90, n_phi_d.
inline std::string sample_merl(std::int32_t n_phi_d = 180) {
  std::string bytes;
  for (const std::int32_t n : {90, 90, n_phi_d}) append(bytes, n);
  const double value = 100;
  const std::string cell(reinterpret_cast<const char*>(&value), sizeof(value));
  bytes.reserve(12 + 3ull * 90 * 90 * 180 * 8);
  for (int i = 0; i < 3 * 90 * 90 * 180; ++i) bytes += cell;
  return bytes;
}

/// An isotropic RGB file of RGL with three incident angles and 8 x 8 nodes, of the colour `rgb` and
/// of `luminance_angles` slices of luminance (3 are right).
inline std::string sample_rgl(float rgb = 0.2f, std::uint64_t luminance_angles = 3) {
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::uint64_t> shape;
    std::string data;
  };
  const auto floats = [](const std::string& name, const std::vector<std::uint64_t>& shape,
                         float value) {
    Field field{name, 10, shape, ""};
    std::uint64_t count = 1;
    for (const std::uint64_t n : shape) count *= n;
    for (std::uint64_t i = 0; i < count; ++i) append(field.data, value);
    return field;
  };
  std::vector<Field> fields = {{"description", 1, {6}, "sample"},
                               {"jacobian", 1, {1}, std::string(1, '\1')},
                               floats("phi_i", {1}, 0),
                               floats("theta_i", {3}, 0),
                               floats("ndf", {1, 8}, 1),
                               floats("sigma", {1, 8}, 1),
                               floats("vndf", {1, 3, 8, 8}, 1),
                               floats("luminance", {1, luminance_angles, 8, 8}, 1),
                               floats("rgb", {1, 3, 3, 8, 8}, rgb)};
  fields[3].data.clear();
  for (const float theta : {0.0f, 0.8f, 1.55f}) append(fields[3].data, theta);

  std::uint64_t offset = 18;
  for (const Field& field : fields)
    offset += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
  std::string bytes("tensor_file\0\1\0", 14), data;
  append(bytes, static_cast<std::uint32_t>(fields.size()));
  for (const Field& field : fields) {
    append(bytes, static_cast<std::uint16_t>(field.name.size()));
    bytes += field.name;
    append(bytes, static_cast<std::uint16_t>(field.shape.size()));
    append(bytes, field.type);
    append(bytes, offset + data.size());
    for (const std::uint64_t n : field.shape) append(bytes, n);
    data += field.data;
  }
  return bytes + data;
}

}  // namespace gonio::test
