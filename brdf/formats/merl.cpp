#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include <gonio/brdf/formats/interpolate.h>
#include <gonio/brdf/formats/merl.h>
#include <gonio/brdf/formats/repair.h>
#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/fast_math.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio {
namespace {

std::string dimensions_text(const std::int32_t (&n)[3]) {
  return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]);
}

// Both directions of a cell centre above the horizon: cos(theta_h) cos(theta_d) is their mean
// height, sin(theta_h) sin(theta_d) cos(phi_d) half the difference.
bool above_horizon(double theta_h, double theta_d, double phi_d) {
  return std::cos(theta_h) * std::cos(theta_d) > std::abs(std::sin(theta_h) * std::sin(theta_d) * std::cos(phi_d));
}

}  // namespace

MerlFile parse_merl(const std::string& bytes, Problems& problems) {
  MerlFile file;
  ByteReader reader(bytes);
  std::int32_t n[3] = {0, 0, 0};
  if (!reader.read(n, 3)) {
    problems.push_back({"header", std::to_string(bytes.size()) + " bytes", "12 bytes (three int32)", true});
    return file;
  }
  if (n[0] != MerlFile::n_theta_h || n[1] != MerlFile::n_theta_d || (n[2] != 180 && n[2] != 360)) {
    problems.push_back({"dimensions", dimensions_text(n), "90 x 90 x 180 or 90 x 90 x 360", true});
    return file;
  }
  file.n_phi_d = n[2];
  const std::size_t count = 3 * file.cells();
  if (reader.remaining() != count * sizeof(double)) {
    problems.push_back({"file size", std::to_string(bytes.size()) + " bytes",
                        std::to_string(12 + count * sizeof(double)) + " bytes for dimensions " + dimensions_text(n),
                        true});
    return file;
  }
  file.values.resize(count);
  reader.read(file.values.data(), count);
  return file;
}

MerlFile read_merl(const std::filesystem::path& path) {
  Problems problems;
  MerlFile file = parse_merl(read_bytes(path), problems);
  throw_if_fatal(path.string(), problems);
  return file;
}

void write_merl(const std::filesystem::path& path, const MerlFile& file) {
  if ((file.n_phi_d != 180 && file.n_phi_d != 360) || file.values.size() != 3 * file.cells()) {
    throw Error(path.string() + ": values: found " + std::to_string(file.values.size()) + " for n_phi_d " +
                std::to_string(file.n_phi_d) + ", expected 3 x 90 x 90 x n_phi_d with n_phi_d 180 or 360");
  }
  write_stream_atomically(path, [&](std::ostream& stream) {
    const std::int32_t n[3] = {MerlFile::n_theta_h, MerlFile::n_theta_d, file.n_phi_d};
    stream.write(reinterpret_cast<const char*>(n), sizeof(n));
    stream.write(reinterpret_cast<const char*>(file.values.data()),
                 static_cast<std::streamsize>(file.values.size() * sizeof(double)));
  });
}

HalfDifference half_difference(const glm::vec3& wi, const glm::vec3& wo) noexcept {
  const glm::vec3 h = wi + wo;  // length 2 cos(theta_d)
  const glm::vec3 e = wi - wo;  // length 2 sin(theta_d), perpendicular to h
  const float h_length = glm::length(h);
  float hx = h.x, hy = h.y;
  float h_xy = std::sqrt(hx * hx + hy * hy);
  const float theta_h = fast_atan2(h_xy, h.z);
  if (h_xy > 0.0f) {
    hx /= h_xy;
    hy /= h_xy;
  } else {
    hx = 1.0f;
    hy = 0.0f;
  }
  // e against the tangent (rising theta_h) and the bitangent of h, both times |h|.
  const float along_tangent = h.z * (hx * e.x + hy * e.y) - h_xy * e.z;
  const float along_bitangent = h_length * (hx * e.y - hy * e.x);
  return {theta_h, fast_atan2(glm::length(e), h_length), fast_atan2(along_bitangent, along_tangent)};
}

void directions_from_half_difference(double theta_h, double theta_d, double phi_d, glm::vec3& wi,
                                     glm::vec3& wo) noexcept {
  const double sh = std::sin(theta_h), ch = std::cos(theta_h);
  const double dx = std::sin(theta_d) * std::cos(phi_d), dy = std::sin(theta_d) * std::sin(phi_d);
  const double dz = std::cos(theta_d);
  wi = glm::vec3(glm::dvec3(ch * dx + sh * dz, dy, ch * dz - sh * dx));
  wo = glm::vec3(glm::dvec3(sh * dz - ch * dx, -dy, ch * dz + sh * dx));
}

MerlTable::MerlTable(const MerlFile& file, const CellPolicies& policies) : n_phi_d_(file.n_phi_d) {
  const std::size_t n = file.cells();
  if (file.values.size() != 3 * n) {
    throw Error("values: found " + std::to_string(file.values.size()) + ", expected " + std::to_string(3 * n));
  }
  values_.reserve(n + 1);
  values_.resize(n);
  std::vector<CellKind> kinds(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) {
      values_[i][c] = static_cast<float>(file.values[static_cast<std::size_t>(c) * n + i] * merl_scale[c]);
    }
    kinds[i] = kind_of(values_[i]);
    if (kinds[i] == CellKind::negative) kinds[i] = CellKind::missing;
  }
  std::size_t i = 0;
  for (int h = 0; h < MerlFile::n_theta_h; ++h) {
    const double theta_h = pi<double> / 2 * ((h + 0.5) / 90) * ((h + 0.5) / 90);
    for (int d = 0; d < MerlFile::n_theta_d; ++d) {
      for (int p = 0; p < n_phi_d_; ++p, ++i) {
        if (!above_horizon(theta_h, (d + 0.5) * pi<double> / 180, (p + 0.5) * pi<double> / 180)) {
          kinds[i] = CellKind::outside;
        }
      }
    }
  }
  const auto n_phi = static_cast<std::size_t>(n_phi_d_);
  counts_ = repair_cells(values_, kinds, policies,
                         {{90, 90, n_phi, false}, {90 * 90, n_phi, 1, true}, {1, 90, 90 * n_phi, false}});
  values_.emplace_back(0.0f);
  measured_ = MeasuredCells(cell_origins(kinds, policies), MerlFile::n_theta_d, n_phi_d_);
}

struct MerlTable::Neighbours {
  Lerp h, d, p;
};

MerlTable::Neighbours MerlTable::neighbours_of(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  constexpr float per_degree = static_cast<float>(180 / pi<double>);
  const HalfDifference a = half_difference(wi, wo);
  const Lerp h = lerp_clamped(90.0f * std::sqrt(a.theta_h * static_cast<float>(2 / pi<double>)) - 0.5f, 90);
  const Lerp d = lerp_clamped(a.theta_d * per_degree - 0.5f, 90);
  float phi_bin = a.phi_d * per_degree;
  if (phi_bin < 0.0f) phi_bin += static_cast<float>(n_phi_d_);
  return {h, d, lerp_periodic(phi_bin - 0.5f, n_phi_d_)};
}

float MerlTable::measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const Neighbours between = neighbours_of(wi, wo);
  return measured_.share(between.h, between.d, between.p);
}

glm::vec3 MerlTable::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const Neighbours between = neighbours_of(wi, wo);
  const Lerp &h = between.h, &d = between.d, &p = between.p;
  const auto row = [&](int ih, int id) {
    const glm::vec3* cells = values_.data() + (ih * MerlFile::n_theta_d + id) * n_phi_d_;
    return lerp(cells[p.lo], cells[p.hi], p.t);
  };
  return lerp(lerp(row(h.lo, d.lo), row(h.lo, d.hi), d.t), lerp(row(h.hi, d.lo), row(h.hi, d.hi), d.t), h.t);
}

}  // namespace gonio
