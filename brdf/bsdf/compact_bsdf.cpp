#include <gonio/brdf/bsdf/compact_bsdf.h>

#include <algorithm>
#include <cmath>

#include <gonio/brdf/bsdf/frame.h>
#include <gonio/mapping/base/error.h>

namespace gonio {

CompactBsdf::CompactBsdf(const StackGrid& diagrams, Interpolation interpolation, Storage storage, Colour colour)
    : stack_(diagrams, interpolation, storage), colour_(std::move(colour)) {
  if (colour_.empty()) throw Error("compact BSDF: colour: found none, expected one");
}

std::optional<BsdfSample> CompactBsdf::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(is_above(wi) && std::isfinite(u.x + u.y))) return std::nullopt;
  const IncidentFrame frame(wi);
  const auto drawn = stack_.sample(frame.theta_i, u.x, u.y);
  if (!(drawn.pdf > 0 && drawn.wo.z > 0)) return std::nullopt;
  const float share = std::min(drawn.wo.z / min_cosine, 1.0f);
  return BsdfSample{frame.to_surface(drawn.wo), drawn.pdf, colour_.eval(frame.theta_i, {u.x, u.y}) * share};
}

float CompactBsdf::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(is_above(wi) && is_above(wo))) return 0;
  const IncidentFrame frame(wi);
  return stack_.pdf(frame.theta_i, frame.to_diagram(wo));
}

glm::vec3 CompactBsdf::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(is_above(wi) && is_above(wo))) return glm::vec3(0);
  const IncidentFrame frame(wi);
  const auto inverse = stack_.invert(frame.theta_i, frame.to_diagram(wo));
  if (!inverse) return glm::vec3(0);
  return colour_.eval(frame.theta_i, inverse->at) * (inverse->pdf / std::max(wo.z, min_cosine));
}

}  // namespace gonio
