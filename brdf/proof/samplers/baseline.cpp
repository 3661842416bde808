#include <algorithm>
#include <cmath>

#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/brdf/value/frame.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {
namespace {

constexpr float two_pi = 2 * pi<float>;
// Keeps drawn directions above the horizon, where the weight would be 0/0.
constexpr float largest_radius2 = 1 - 1e-7f;

BsdfSample weighted(const BrdfTable& table, const glm::vec3& wi, const glm::vec3& wo, float pdf) {
  return {wo, pdf, table.eval(wi, wo) * (wo.z / pdf)};
}

}  // namespace

std::optional<BsdfSample> UniformSampler::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(is_above(wi) && std::isfinite(u.x + u.y))) return std::nullopt;
  const DiskPoint<float> disk = square_to_disk(u.x, u.y);
  const float r = std::sqrt(std::min(disk.r2, largest_radius2));
  return weighted(*table_, wi, polar_to_direction(Polar<float>{r, two_pi * disk.turn}), 1 / two_pi);
}

float UniformSampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return is_above(wi) && is_above(wo) ? 1 / two_pi : 0;
}

std::optional<BsdfSample> CosineSampler::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(is_above(wi) && std::isfinite(u.x + u.y))) return std::nullopt;
  const DiskPoint<float> disk = square_to_disk(u.x, u.y);
  const float sin2 = std::min(disk.r2, largest_radius2), sin_theta = std::sqrt(sin2);
  const float phi = two_pi * disk.turn;
  const glm::vec3 wo(sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::sqrt(1 - sin2));
  return weighted(*table_, wi, wo, wo.z / pi<float>);
}

float CosineSampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return is_above(wi) && is_above(wo) ? wo.z / pi<float> : 0;
}

RglSampler::RglSampler(std::shared_ptr<const BrdfTable> table)
    : table_(required_table(std::move(table), "RGL sampler")), rgl_(std::get_if<RglTable>(&table_->data())) {
  if (!rgl_) throw Error(table_->info().source + ": format: found " + table_->info().format + ", expected rgl");
}

std::optional<BsdfSample> RglSampler::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(is_above(wi) && std::isfinite(u.x + u.y))) return std::nullopt;
  const auto drawn = rgl_->sample(wi, u.x, u.y);
  if (!drawn || !(drawn->pdf > 0)) return std::nullopt;
  return BsdfSample{drawn->wo, drawn->pdf, drawn->f_r * (drawn->wo.z / drawn->pdf)};
}

float RglSampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  return is_above(wi) && is_above(wo) ? rgl_->pdf(wi, wo) : 0;
}

}  // namespace gonio
