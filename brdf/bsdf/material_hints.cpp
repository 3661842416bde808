#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gonio/brdf/bsdf/material_hints.h>
#include <gonio/brdf/value/luminance.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {
namespace {

constexpr int side = 32;
constexpr float step = 2 * pi<float> / 180;

/// Calls function(sample) for side x side points of the unit square.
template <class Function>
void for_each_draw(const MaterialHints::Draw& draw, float theta_i, const Function& function) {
  const glm::vec3 wi(std::sin(theta_i), 0.0f, std::cos(theta_i));
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const glm::vec2 u((static_cast<float>(i) + 0.5f) / side, (static_cast<float>(j) + 0.5f) / side);
      if (const auto s = draw(wi, u)) function(*s);
    }
  }
}

}  // namespace

MaterialHints::MaterialHints(const Draw& draw) {
  for (std::size_t k = 0; k < albedo_.size(); ++k) {
    glm::dvec3 sum(0.0);
    for_each_draw(draw, static_cast<float>(k) * step, [&](const BsdfSample& s) { sum += glm::dvec3(s.weight); });
    albedo_[k] = glm::vec3(sum / double{side * side});
  }
  // tan(theta_h) at normal incidence, where h halves the angle of wo, and what is reflected there.
  std::vector<std::pair<float, float>> slopes;
  float total = 0;
  for_each_draw(draw, 0.0f, [&](const BsdfSample& s) {
    const float theta_h = 0.5f * std::acos(std::min(s.wo.z, 1.0f));
    slopes.emplace_back(std::tan(theta_h), luminance(s.weight));
    total += luminance(s.weight);
  });
  std::sort(slopes.begin(), slopes.end());
  float below = 0;
  for (const auto& [slope, weight] : slopes) {
    below += weight;
    if (total > 0 && below >= 0.5f * total) {
      roughness_ = std::min(slope, 1.0f);
      break;
    }
  }
}

glm::vec3 MaterialHints::albedo(float theta_i) const noexcept {
  if (!(theta_i < pi<float> / 2)) return glm::vec3(0.0f);
  const float at = std::clamp(theta_i / step, 0.0f, static_cast<float>(angles - 1));
  const auto k = std::min(static_cast<std::size_t>(at), albedo_.size() - 2);
  const float t = at - static_cast<float>(k);
  return (1 - t) * albedo_[k] + t * albedo_[k + 1];
}

}  // namespace gonio
