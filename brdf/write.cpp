#include <gonio/brdf/parallel.h>
#include <gonio/brdf/write.h>
#include <gonio/mapping/error.h>

#include <cmath>
#include <string>

namespace gonio {
namespace {

constexpr double pi = 3.14159265358979323846;

}  // namespace

MerlFile sample_as_merl(const BrdfTable& table, int n_phi_d) {
  if (n_phi_d != 180 && n_phi_d != 360) {
    throw Error("n_phi_d: found " + std::to_string(n_phi_d) + ", expected 180 or 360");
  }
  MerlFile file;
  file.n_phi_d = n_phi_d;
  const std::size_t n = file.cells(), row = n / MerlFile::n_theta_h;
  file.values.resize(3 * n);
  parallel_for(MerlFile::n_theta_h, [&](std::size_t i) {
    const double s = (static_cast<double>(i) + 0.5) / MerlFile::n_theta_h;
    for (std::size_t k = 0; k < row; ++k) {
      const auto theta_d = static_cast<double>(k / static_cast<std::size_t>(n_phi_d));
      const auto phi_d = static_cast<double>(k % static_cast<std::size_t>(n_phi_d));
      glm::vec3 wi, wo;
      directions_from_half_difference(pi / 2 * s * s, (theta_d + 0.5) * pi / 180,
                                      (phi_d + 0.5) * pi / 180, wi, wo);
      const bool above = wi.z > 0.0f && wo.z > 0.0f;
      glm::vec3 f_r = table.eval(wi, wo);
      if (n_phi_d == 180) f_r = 0.5f * (f_r + table.eval(wo, wi));
      for (int c = 0; c < 3; ++c) {
        file.values[static_cast<std::size_t>(c) * n + i * row + k] =
            above ? f_r[c] / merl_scale[c] : -1.0;
      }
    }
  });
  return file;
}

GridFile sample_as_grid(const BrdfTable& table, int n_theta, int n_phi) {
  if (n_theta < 1 || n_phi < 1 || n_theta > max_grid_side || n_phi > max_grid_side) {
    throw Error("grid: found " + std::to_string(n_theta) + " thetas and " + std::to_string(n_phi) +
                " phis, expected 1 to " + std::to_string(max_grid_side));
  }
  GridFile file;
  file.n_theta_in = file.n_theta_out = n_theta;
  file.n_phi = n_phi;
  const auto row = static_cast<std::size_t>(n_theta) * n_phi;
  file.values.resize(static_cast<std::size_t>(n_theta) * row * 3);
  parallel_for(static_cast<std::size_t>(n_theta), [&](std::size_t in) {
    const double theta_i = (static_cast<double>(in) + 0.5) * pi / 2 / n_theta;
    const glm::vec3 wi(glm::dvec3(std::sin(theta_i), 0.0, std::cos(theta_i)));
    float* value = &file.values[in * row * 3];
    for (int out = 0; out < n_theta; ++out) {
      const double theta_o = (out + 0.5) * pi / 2 / n_theta;
      for (int p = 0; p < n_phi; ++p) {
        const double phi = (p + 0.5) * pi / n_phi;
        const glm::vec3 wo(glm::dvec3(std::sin(theta_o) * std::cos(phi),
                                      std::sin(theta_o) * std::sin(phi), std::cos(theta_o)));
        const glm::vec3 f_r = table.eval(wi, wo);
        for (int c = 0; c < 3; ++c) *value++ = f_r[c];
      }
    }
  });
  return file;
}

void write_table_as_merl(const BrdfTable& table, const std::filesystem::path& path, int n_phi_d) {
  write_merl(path, sample_as_merl(table, n_phi_d));
}

void write_table_as_mbsdf(const BrdfTable& table, const std::filesystem::path& path, int n_theta,
                          int n_phi) {
  write_mbsdf(path, sample_as_grid(table, n_theta, n_phi));
}

}  // namespace gonio
