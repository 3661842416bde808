#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/formats/merl.h>

#include "tests/support/files.h"

namespace gonio::test {

constexpr double pi = 3.14159265358979323846;

inline glm::vec3 direction(double theta, double phi) {
  return glm::vec3(glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
}

/// Uniform in solid angle over the upper hemisphere.
inline glm::vec3 random_direction(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform;
  const double phi = 2 * pi * uniform(engine);
  return direction(std::acos(1.0 - uniform(engine)), phi);
}

/// A MERL file whose f_r is f(theta_h index, theta_d index, phi_d index) in every channel.
template <class Function>
MerlFile make_merl(const Function& f, int n_phi_d = 180) {
  MerlFile file;
  file.n_phi_d = n_phi_d;
  file.values.resize(3 * file.cells());
  std::size_t i = 0;
  for (const double scale : merl_scale) {
    for (int h = 0; h < 90; ++h) {
      for (int d = 0; d < 90; ++d) {
        for (int p = 0; p < n_phi_d; ++p) file.values[i++] = f(h, d, p) / scale;
      }
    }
  }
  return file;
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Builds the container of RGL files.
struct TensorBuilder {
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::uint64_t> shape;
    std::string data;
  };
  std::vector<Field> fields;

  void add(const std::string& name, const std::vector<std::uint64_t>& shape, const std::vector<float>& values) {
    fields.push_back({name, 10, shape, std::string(reinterpret_cast<const char*>(values.data()), values.size() * 4)});
  }
  void add_octets(const std::string& name, const std::string& octets) {
    fields.push_back({name, 1, {octets.size()}, octets});
  }
  Field& operator[](const std::string& name) {
    for (Field& field : fields) {
      if (field.name == name) return field;
    }
    throw std::out_of_range(name);
  }
  void remove(const std::string& name) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].name == name) fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  std::string bytes() const {
    std::size_t offset = 18;
    for (const Field& field : fields) offset += 13 + field.name.size() + 8 * field.shape.size();
    std::string result("tensor_file\0\1\0", 14);
    append(result, static_cast<std::uint32_t>(fields.size()));
    std::string data;
    for (const Field& field : fields) {
      append(result, static_cast<std::uint16_t>(field.name.size()));
      result += field.name;
      append(result, static_cast<std::uint16_t>(field.shape.size()));
      append(result, field.type);
      append(result, static_cast<std::uint64_t>(offset + data.size()));
      for (const std::uint64_t n : field.shape) append(result, n);
      data += field.data;
    }
    return result + data;
  }
};

/// A small isotropic RGL file with 3 incident angles: every density uniform, ndf = sigma = 1,
/// colour constant. f_r cos(theta_o) is then colour / 4, or colour itself with `jacobian` false.
inline TensorBuilder make_rgl(const glm::vec3& colour = {0.4f, 0.8f, 1.2f}, bool jacobian = true,
                              std::uint64_t n_phi = 1) {
  TensorBuilder file;
  file.add_octets("description", "uniform");
  std::vector<float> phi(n_phi);
  std::iota(phi.begin(), phi.end(), 0.0f);
  file.add("phi_i", {n_phi}, phi);
  file.add("theta_i", {3}, {0.0f, 0.8f, 1.57f});
  file.add("ndf", {2, 4}, std::vector<float>(8, 1.0f));
  file.add("sigma", {2, 4}, std::vector<float>(8, 1.0f));
  file.add("vndf", {n_phi, 3, 5, 4}, std::vector<float>(n_phi * 60, 2.0f));
  file.add("luminance", {n_phi, 3, 3, 2}, std::vector<float>(n_phi * 18, 7.0f));
  std::vector<float> rgb;
  for (std::uint64_t slice = 0; slice < n_phi * 3; ++slice) {
    for (int c = 0; c < 3; ++c) rgb.insert(rgb.end(), 6, colour[c]);
  }
  file.add("rgb", {n_phi, 3, 3, 3, 2}, rgb);
  file.add_octets("jacobian", std::string(1, jacobian ? '\1' : '\0'));
  return file;
}

/// An MBSDF file with one part; `values` in the order of the file.
inline std::string make_mbsdf(std::uint32_t type, std::uint32_t n_theta, std::uint32_t n_phi,
                              const std::vector<float>& values, const std::string& part = "MBSDF_DATA_REFLECTION=\n") {
  std::string bytes = "NVIDIA ARC MBSDF V1\n" + part;
  append(bytes, type);
  append(bytes, n_theta);
  append(bytes, n_phi);
  for (const float value : values) append(bytes, value);
  return bytes;
}

}  // namespace gonio::test
