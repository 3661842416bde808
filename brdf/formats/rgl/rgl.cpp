#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <gonio/brdf/formats/repair.h>
#include <gonio/brdf/formats/rgl/rgl.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/fast_math.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio {
namespace {

// Of the unit square: draws nearer to its sides have their pdf computed from their direction.
constexpr float edge = 0x1p-12f;

// Elevation and azimuth of a direction that need not have unit length.
float theta_of(const glm::vec3& w) noexcept { return fast_atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z); }

// The file's chart of directions: u_theta = sqrt(2 theta / pi), u_phi = (phi + pi) / (2 pi).
float u_theta_of(float theta) noexcept { return std::sqrt(theta * (2.0f / pi<float>)); }

// Solid angle of the normals per unit area of the chart. The authors' loader lets it fall to 1e-6 and no further: next
// to the pole, where the densities of the chart fall to 0 with it, the pdf would then be too small by any factor.
float area_of_normals(float u_theta, float sine) noexcept {
  return std::max(2.0f * pi<float> * pi<float> * u_theta * sine, 1e-20f);
}

float bilinear(const RglFile::Grid& grid, float x, float y) noexcept {
  const Lerp lx = lerp_clamped(x * static_cast<float>(grid.width - 1), grid.width);
  const Lerp ly = lerp_clamped(y * static_cast<float>(grid.height - 1), grid.height);
  const auto row = [&](int j) {
    const float* values = grid.values.data() + j * grid.width;
    return lerp(values[lx.lo], values[lx.hi], lx.t);
  };
  return lerp(row(ly.lo), row(ly.hi), ly.t);
}

// A grid's values along theta at phi = 0, which is u_phi = 0.5.
std::vector<float> middle_line(const RglFile::Grid& grid) {
  const Lerp y = lerp_clamped(0.5f * static_cast<float>(grid.height - 1), grid.height);
  std::vector<float> line(static_cast<std::size_t>(grid.width));
  for (int x = 0; x < grid.width; ++x)
    line[static_cast<std::size_t>(x)] = lerp(grid.values[static_cast<std::size_t>(y.lo * grid.width + x)],
                                             grid.values[static_cast<std::size_t>(y.hi * grid.width + x)], y.t);
  return line;
}

CellCounts repair_grid(RglFile::Grid& grid, const std::string& name, const CellPolicies& policies) {
  std::vector<glm::vec3> cells(grid.values.size());
  std::vector<CellKind> kinds(grid.values.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i] = glm::vec3(grid.values[i]);
    kinds[i] = kind_of(cells[i]);
  }
  const auto n = static_cast<std::size_t>(grid.slices);
  const auto height = static_cast<std::size_t>(grid.height), width = static_cast<std::size_t>(grid.width);
  const CellCounts counts =
      repair_cells(cells, kinds, policies,
                   {{n * height, width, 1, false}, {n, height, width, false}, {1, n, height * width, false}}, name);
  for (std::size_t i = 0; i < cells.size(); ++i) grid.values[i] = cells[i].r;
  return counts;
}

}  // namespace

CellCounts repair_densities(RglFile& file, const CellPolicies& policies) {
  CellCounts all;
  const auto repair = [&](RglFile::Grid& grid, const char* name) {
    const CellCounts counts = repair_grid(grid, name, policies);
    all.total += counts.total;
    all.negative += counts.negative;
    all.nonfinite += counts.nonfinite;
  };
  repair(file.ndf, "ndf");
  repair(file.sigma, "sigma");
  repair(file.vndf, "vndf");
  repair(file.luminance, "luminance");
  return all;
}

struct RglTable::Normal {
  float u_theta, u_phi;
  float jacobian;  // solid angle of the normals per unit area of the chart
};

RglTable::RglTable(RglFile file, const CellPolicies& policies)
    : density_counts_(repair_densities(file, policies)),
      theta_i_(std::move(file.theta_i)),
      ndf_(std::move(file.ndf)),
      sigma_(middle_line(file.sigma)),
      vndf_(file.vndf.slices, file.vndf.height, file.vndf.width, file.vndf.values),
      luminance_(file.luminance.slices, file.luminance.height, file.luminance.width, file.luminance.values),
      colour_height_(file.colour_height),
      colour_width_(file.colour_width),
      colour_(std::move(file.colour)),
      jacobian_(file.jacobian),
      n_wavelengths_(file.n_wavelengths) {
  std::vector<CellKind> kinds;
  kinds.reserve(colour_.size());
  for (const glm::vec3& cell : colour_) kinds.push_back(kind_of(cell));
  const std::vector<glm::vec3> measured = colour_;
  const auto n = theta_i_.size();
  const auto height = static_cast<std::size_t>(colour_height_);
  const auto width = static_cast<std::size_t>(colour_width_);
  counts_ = repair_cells(colour_, kinds, policies,
                         {{n * height, width, 1, false}, {n, height, width, false}, {1, n, height * width, false}});
  measured_ = MeasuredCells(cell_origins(kinds, policies), colour_height_, colour_width_);
  // Interpolation between a positive and a negative node needs both; value_at() clamps what comes
  // out.
  if (policies.negative == CellPolicy::zero) {
    for (std::size_t i = 0; i < colour_.size(); ++i) {
      if (kinds[i] == CellKind::negative) colour_[i] = measured[i];
    }
  }
  colour_.reserve(colour_.size() + 1);
  colour_.emplace_back(0.0f);
}

Lerp RglTable::slice_at(float theta) const noexcept {
  const int n = static_cast<int>(theta_i_.size());
  int hi = 0;
  while (hi < n && theta_i_[hi] <= theta) ++hi;
  if (hi == 0) return {0, 0, 0.0f};
  if (hi == n) return {n - 1, n - 1, 0.0f};
  return {hi - 1, hi, (theta - theta_i_[hi - 1]) / (theta_i_[hi] - theta_i_[hi - 1])};
}

// Both hardly depend on the azimuth in an isotropic file; phi = 0 is u_phi = 0.5.
float RglTable::ndf(float theta) const noexcept { return bilinear(ndf_, u_theta_of(theta), 0.5f); }
float RglTable::sigma(float theta) const noexcept {
  const auto n = static_cast<int>(sigma_.size());
  const Lerp x = lerp_clamped(u_theta_of(theta) * static_cast<float>(n - 1), n);
  return lerp(sigma_[static_cast<std::size_t>(x.lo)], sigma_[static_cast<std::size_t>(x.hi)], x.t);
}

RglTable::Normal RglTable::half_vector(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const glm::vec3 m = wi + wo;
  // Azimuth relative to wi; at the pole, where wi has none, relative to +x.
  const bool pole = wi.x == 0.0f && wi.y == 0.0f;
  const float ix = pole ? 1.0f : wi.x, iy = pole ? 0.0f : wi.y;
  const float phi = fast_atan2(ix * m.y - iy * m.x, ix * m.x + iy * m.y);
  const float m_xy = std::sqrt(m.x * m.x + m.y * m.y);
  const float u_theta = u_theta_of(fast_atan2(m_xy, m.z));
  const float u_phi = phi * (0.5f / pi<float>)+0.5f;
  return {u_theta, u_phi, area_of_normals(u_theta, m_xy / glm::length(m))};
}

glm::vec3 RglTable::colour_at(const Lerp& slice, float x, float y) const noexcept {
  const Lerp lx = lerp_clamped(x * static_cast<float>(colour_width_ - 1), colour_width_);
  const Lerp ly = lerp_clamped(y * static_cast<float>(colour_height_ - 1), colour_height_);
  const auto row = [&](int s, int j) {
    const glm::vec3* cells = colour_.data() + (static_cast<std::ptrdiff_t>(s) * colour_height_ + j) * colour_width_;
    return lerp(cells[lx.lo], cells[lx.hi], lx.t);
  };
  return lerp(lerp(row(slice.lo, ly.lo), row(slice.lo, ly.hi), ly.t),
              lerp(row(slice.hi, ly.lo), row(slice.hi, ly.hi), ly.t), slice.t);
}

float RglTable::measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  constexpr float rounding = 1e-5f;
  const float theta_i = theta_of(wi);
  if (theta_i < theta_i_.front() - rounding || theta_i > theta_i_.back() + rounding) return 0.0f;
  const Lerp slice = slice_at(theta_i);
  const Normal normal = half_vector(wi, wo);
  const Warp2d::Point place = vndf_.invert(slice, normal.u_theta, normal.u_phi);
  return measured_.share(slice, lerp_clamped(place.y * static_cast<float>(colour_height_ - 1), colour_height_),
                         lerp_clamped(place.x * static_cast<float>(colour_width_ - 1), colour_width_));
}

glm::vec3 RglTable::value_at(const Normal& normal, float theta_i, const Lerp& slice, float x, float y) const noexcept {
  const glm::vec3 colour = glm::max(colour_at(slice, x, y), 0.0f);
  if (!jacobian_) return colour;
  const float area = sigma(theta_i);
  if (!(area > 0.0f)) return glm::vec3(0.0f);
  // A damaged file may hold an ndf and a sigma whose quotient no float holds.
  const float factor =
      std::min(bilinear(ndf_, normal.u_theta, normal.u_phi) / (4.0f * area), std::numeric_limits<float>::max());
  return colour * factor;
}

glm::vec3 RglTable::eval_cosine(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const float theta_i = theta_of(wi);
  const Lerp slice = slice_at(theta_i);
  const Normal normal = half_vector(wi, wo);
  const Warp2d::Point place = vndf_.invert(slice, normal.u_theta, normal.u_phi);
  return value_at(normal, theta_i, slice, place.x, place.y);
}

glm::vec3 RglTable::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return eval_cosine(wi, wo) / std::max(wo.z, min_cosine);
}

float RglTable::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  const Lerp slice = slice_at(theta_of(wi));
  const Normal normal = half_vector(wi, wo);
  const Warp2d::Point place = vndf_.invert(slice, normal.u_theta, normal.u_phi);
  const float cosine = 0.5f * glm::length(wi + wo);  // wi . m
  return luminance_.eval(slice, place.x, place.y) * place.density / (normal.jacobian * 4.0f * cosine);
}

std::optional<RglTable::Sample> RglTable::sample(const glm::vec3& wi, float u1, float u2) const noexcept {
  const float theta_i = theta_of(wi);
  const Lerp slice = slice_at(theta_i);
  const Warp2d::Point place = luminance_.sample(slice, u2, u1);
  const Warp2d::Point chart = vndf_.sample(slice, place.x, place.y);

  const float theta_m = 0.5f * pi<float> * chart.x * chart.x;
  const float phi_m = (2.0f * chart.y - 1.0f) * pi<float> + fast_atan2(wi.y, wi.x);
  const float sine = std::sin(theta_m);
  const glm::vec3 m(sine * std::cos(phi_m), sine * std::sin(phi_m), std::cos(theta_m));
  const float cosine = glm::dot(wi, m);
  const glm::vec3 wo = glm::normalize(2.0f * cosine * m - wi);
  if (!(cosine > 0.0f && wo.z > 0.0f)) return std::nullopt;

  const Normal normal{chart.x, chart.y, area_of_normals(chart.x, sine)};
  const float density = place.density * chart.density / (normal.jacobian * 4.0f * cosine);
  // Where a density of the chain falls to 0 at an edge, what the warps say of a place on the edge is not what they say
  // of the direction, which is rounded.
  if (std::min({u1, 1.0f - u1, u2, 1.0f - u2}) < edge) {
    const float rounded = pdf(wi, wo);
    if (!(rounded > 0.0f)) return std::nullopt;
    return Sample{wo, rounded, eval(wi, wo)};
  }
  return Sample{wo, density, value_at(normal, theta_i, slice, place.x, place.y) / std::max(wo.z, min_cosine)};
}

}  // namespace gonio
