#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gonio/brdf/bsdf/material_hints.h>
#include <gonio/brdf/value/luminance.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {
namespace {

constexpr int side = 32;
constexpr float step = 2 * pi<float> / 180;

constexpr std::size_t count = side * side;

/// Draws from points in the middle of side x side cells of the unit square, at one incident angle after the other.
class Draws {
 public:
  Draws() {
    for (std::size_t k = 0; k < count; ++k) {
      u_[k] = (static_cast<float>(k % side) + 0.5f) / side;
      v_[k] = (static_cast<float>(k / side) + 0.5f) / side;
    }
  }
  void draw(const MaterialHints::Draw& draw, float theta_i) {
    std::fill_n(wi_x_, count, std::sin(theta_i)), std::fill_n(wi_z_, count, std::cos(theta_i));
    draw(count, {wi_x_, wi_y_, wi_z_}, u_, v_, {wo_x_, wo_y_, wo_z_}, pdf_, {red_, green_, blue_});
  }
  glm::vec3 weight(std::size_t k) const { return {red_[k], green_[k], blue_[k]}; }
  float wo_z(std::size_t k) const { return wo_z_[k]; }

 private:
  float wi_x_[count], wi_y_[count] = {}, wi_z_[count], u_[count], v_[count];
  float wo_x_[count], wo_y_[count], wo_z_[count], pdf_[count], red_[count], green_[count], blue_[count];
};

}  // namespace

MaterialHints::MaterialHints(const Draw& draw) {
  const auto draws = std::make_unique<Draws>();
  // Backwards, so that the last ones are at normal incidence.
  for (std::size_t k = albedo_.size(); k-- > 0;) {
    draws->draw(draw, static_cast<float>(k) * step);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < count; ++i) sum += glm::dvec3(draws->weight(i));
    albedo_[k] = glm::vec3(sum / static_cast<double>(count));
  }
  // tan(theta_h), where h halves the angle of wo, and what is reflected there.
  std::vector<std::pair<float, float>> slopes;
  float total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float theta_h = 0.5f * std::acos(std::min(draws->wo_z(i), 1.0f)), weight = luminance(draws->weight(i));
    slopes.emplace_back(std::tan(theta_h), weight);
    total += weight;
  }
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
