#include <algorithm>
#include <cmath>
#include <string>

#include <gonio/brdf/resample/table_resample.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/parallel.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio {
namespace {

// Samples at the cell centres of MERL; negative where a direction is at or below the horizon.
std::vector<glm::vec3> merl_centres(const BrdfTable& table, const MerlFile& file) {
  std::vector<glm::vec3> f_r(file.cells());
  const std::size_t row = f_r.size() / MerlFile::n_theta_h;
  const auto n_phi = static_cast<std::size_t>(file.n_phi_d);
  parallel_for(MerlFile::n_theta_h, [&](std::size_t i) {
    const double s = (static_cast<double>(i) + 0.5) / MerlFile::n_theta_h;
    for (std::size_t k = 0; k < row; ++k) {
      const double theta_d = (static_cast<double>(k / n_phi) + 0.5) * pi<double> / 180;
      const double phi_d = (static_cast<double>(k % n_phi) + 0.5) * pi<double> / 180;
      glm::vec3 wi, wo;
      directions_from_half_difference(pi<double> / 2 * s * s, theta_d, phi_d, wi, wo);
      const bool above = wi.z > 0.0f && wo.z > 0.0f;
      glm::vec3 value = table.eval(wi, wo);
      if (file.n_phi_d == 180) value = 0.5f * (value + table.eval(wo, wi));
      f_r[i * row + k] = above ? value : glm::vec3(-1.0f);
    }
  });
  return f_r;
}

// Sum over the three axes of the second difference at cell i, left out along an axis where a
// neighbour is below the horizon or beyond the table.
glm::vec3 second_differences(const std::vector<glm::vec3>& f_r, std::size_t i, std::size_t n_phi) {
  const std::size_t p = i % n_phi, d = i / n_phi % MerlFile::n_theta_d;
  const std::size_t h = i / n_phi / MerlFile::n_theta_d, plane = n_phi * MerlFile::n_theta_d;
  glm::vec3 sum(0.0f);
  const auto add = [&](std::size_t below, std::size_t above) {
    if (f_r[below].r >= 0.0f && f_r[above].r >= 0.0f) sum += f_r[below] - 2.0f * f_r[i] + f_r[above];
  };
  if (h > 0 && h + 1 < MerlFile::n_theta_h) add(i - plane, i + plane);
  if (d > 0 && d + 1 < MerlFile::n_theta_d) add(i - n_phi, i + n_phi);
  add(p > 0 ? i - 1 : i + n_phi - 1, p + 1 < n_phi ? i + 1 : i + 1 - n_phi);
  return sum;
}

}  // namespace

MerlFile sample_as_merl(const BrdfTable& table, int n_phi_d) {
  if (n_phi_d != 180 && n_phi_d != 360) {
    throw Error("n_phi_d: found " + std::to_string(n_phi_d) + ", expected 180 or 360");
  }
  MerlFile file;
  file.n_phi_d = n_phi_d;
  const std::vector<glm::vec3> f_r = merl_centres(table, file);
  // Linear interpolation over cells of width 1 overestimates a function by f''/12 on the mean. A
  // MERL table is linear between the same centres and needs no correction.
  const bool curved = !std::holds_alternative<MerlTable>(table.data());
  const std::size_t n = file.cells();
  file.values.resize(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    glm::vec3 value = f_r[i];
    const bool above = value.r >= 0.0f;
    if (curved && above) {
      value -= second_differences(f_r, i, static_cast<std::size_t>(n_phi_d)) / 12.0f;
    }
    for (int c = 0; c < 3; ++c) {
      file.values[static_cast<std::size_t>(c) * n + i] = above ? std::max(value[c], 0.0f) / merl_scale[c] : -1.0;
    }
  }
  return file;
}

MbsdfFile sample_as_mbsdf(const BrdfTable& table, int n_theta, int n_phi) {
  if (n_theta < 1 || n_phi < 1 || n_theta > max_grid_side || n_phi > max_grid_side) {
    throw Error("grid: found " + std::to_string(n_theta) + " thetas and " + std::to_string(n_phi) +
                " phis, expected 1 to " + std::to_string(max_grid_side));
  }
  MbsdfFile file;
  file.n_theta_in = file.n_theta_out = n_theta;
  file.n_phi = n_phi;
  const auto row = static_cast<std::size_t>(n_theta) * n_phi;
  file.values.resize(static_cast<std::size_t>(n_theta) * row * 3);
  parallel_for(static_cast<std::size_t>(n_theta), [&](std::size_t in) {
    const double theta_i = (static_cast<double>(in) + 0.5) * pi<double> / 2 / n_theta;
    const glm::vec3 wi(glm::dvec3(std::sin(theta_i), 0.0, std::cos(theta_i)));
    float* value = &file.values[in * row * 3];
    for (int out = 0; out < n_theta; ++out) {
      const double theta_o = (out + 0.5) * pi<double> / 2 / n_theta;
      for (int p = 0; p < n_phi; ++p) {
        const double phi = (p + 0.5) * pi<double> / n_phi;
        const glm::vec3 wo(
            glm::dvec3(std::sin(theta_o) * std::cos(phi), std::sin(theta_o) * std::sin(phi), std::cos(theta_o)));
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

void write_table_as_mbsdf(const BrdfTable& table, const std::filesystem::path& path, int n_theta, int n_phi) {
  write_mbsdf(path, sample_as_mbsdf(table, n_theta, n_phi));
}

}  // namespace gonio
