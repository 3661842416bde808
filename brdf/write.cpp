#include <gonio/brdf/parallel.h>
#include <gonio/brdf/write.h>
#include <gonio/mapping/error.h>

#include <cmath>
#include <string>

namespace gonio {
namespace {

constexpr double pi = 3.14159265358979323846;

// Mean of f_r over a cell of MERL, weighted with both cosines; negative below the horizon.
glm::vec3 cell_mean(const BrdfTable& table, double i, double j, double k, bool reciprocal) {
  constexpr int n_sub = 2;
  glm::vec3 sum(0.0f);
  float weights = 0.0f;
  for (int a = 0; a < n_sub * n_sub * n_sub; ++a) {
    const auto offset = [&](int index) { return (index % n_sub + 0.5) / n_sub; };
    const double s = (i + offset(a / n_sub / n_sub)) / MerlFile::n_theta_h;
    glm::vec3 wi, wo;
    directions_from_half_difference(pi / 2 * s * s, (j + offset(a / n_sub)) * pi / 180,
                                    (k + offset(a)) * pi / 180, wi, wo);
    if (!(wi.z > 0.0f && wo.z > 0.0f)) continue;
    const float weight = wi.z * wo.z;
    glm::vec3 f_r = table.eval(wi, wo);
    if (reciprocal) f_r = 0.5f * (f_r + table.eval(wo, wi));
    sum += weight * f_r;
    weights += weight;
  }
  return weights > 0.0f ? sum / weights : glm::vec3(-1.0f);
}

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
    for (std::size_t k = 0; k < row; ++k) {
      const glm::vec3 f_r = cell_mean(
          table, static_cast<double>(i), static_cast<double>(k / static_cast<std::size_t>(n_phi_d)),
          static_cast<double>(k % static_cast<std::size_t>(n_phi_d)), n_phi_d == 180);
      for (int c = 0; c < 3; ++c) {
        file.values[static_cast<std::size_t>(c) * n + i * row + k] =
            f_r[c] < 0.0f ? -1.0 : f_r[c] / merl_scale[c];
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
