#include <algorithm>
#include <cmath>

#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/brdf/value/frame.h>

namespace gonio {

StackBsdf::StackBsdf(const BsdfData& data, std::shared_ptr<const BrdfTable> table)
    : stack_(sampled_stack(data)), colour_(sampled_colour(data, table != nullptr)), table_(std::move(table)) {}

std::optional<BsdfSample> StackBsdf::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(is_above(wi) && std::isfinite(u.x + u.y))) return std::nullopt;
  const IncidentFrame frame(wi);
  const auto drawn = stack_.sample(frame.theta_i, u.x, u.y);
  if (!(drawn.pdf > 0 && drawn.wo.z > 0)) return std::nullopt;
  const glm::vec3 wo = frame.to_surface(drawn.wo);
  if (table_) return BsdfSample{wo, drawn.pdf, table_->eval(wi, wo) * (wo.z / drawn.pdf)};
  return BsdfSample{wo, drawn.pdf,
                    colour_.eval(frame.theta_i, {u.x, u.y}) * std::min(drawn.wo.z / Colour::min_cosine, 1.0f)};
}

float StackBsdf::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(is_above(wi) && is_above(wo))) return 0;
  const IncidentFrame frame(wi);
  return stack_.pdf(frame.theta_i, frame.to_diagram(wo));
}

glm::vec3 StackBsdf::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (table_) return table_->eval(wi, wo);
  if (!(is_above(wi) && is_above(wo))) return glm::vec3(0);
  const IncidentFrame frame(wi);
  const auto inverse = stack_.invert(frame.theta_i, frame.to_diagram(wo));
  if (!inverse) return glm::vec3(0);
  return colour_.eval(frame.theta_i, inverse->at) * (inverse->pdf / std::max(wo.z, Colour::min_cosine));
}

}  // namespace gonio
