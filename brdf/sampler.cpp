#include <gonio/brdf/sampler.h>

#include <string>

#include <gonio/brdf/frame.h>
#include <gonio/mapping/error.h>

namespace gonio {

Sampler::Sampler(std::shared_ptr<const BrdfTable> table, const StackOptions& options, const Progress& progress)
    : stack_(build_stack(*table, options, progress), options.interpolation), table_(std::move(table)) {}

Sampler::Sampler(std::shared_ptr<const BrdfTable> table, const StackGrid& diagrams, Interpolation interpolation)
    : stack_(diagrams, interpolation), table_(std::move(table)) {}

Sampler::Sampler(const StackGrid& diagrams, Colour colour, Interpolation interpolation)
    : stack_(diagrams, interpolation), colour_(std::move(colour)) {
  const std::size_t per_angle = static_cast<std::size_t>(colour_.side() * (colour_.side() / 2));
  if (colour_.empty() || colour_.values().size() != per_angle * diagrams.theta_i.size())
    throw Error("sampler: colour: found " + std::to_string(colour_.values().size()) + " values, expected " +
                std::to_string(per_angle * diagrams.theta_i.size()) + ", one layer per diagram");
}

std::optional<BsdfSample> Sampler::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(wi.z > 0)) return std::nullopt;
  const IncidentFrame frame(wi);
  const auto drawn = stack_.sample(frame.theta_i, u.x, u.y);
  if (!(drawn.pdf > 0 && drawn.wo.z > 0)) return std::nullopt;
  const glm::vec3 wo = frame.to_surface(drawn.wo);
  const glm::vec3 weight = table_ ? table_->eval(wi, wo) * (wo.z / drawn.pdf)
                                  : colour_.eval(stack_.theta_i(), frame.theta_i, {u.x, u.y});
  return BsdfSample{wo, drawn.pdf, weight};
}

float Sampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return 0;
  const IncidentFrame frame(wi);
  return stack_.pdf(frame.theta_i, frame.to_diagram(wo));
}

glm::vec3 Sampler::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return glm::vec3(0);
  if (table_) return table_->eval(wi, wo);
  const IncidentFrame frame(wi);
  const auto inverse = stack_.invert(frame.theta_i, frame.to_diagram(wo));
  if (!inverse) return glm::vec3(0);
  return colour_.eval(stack_.theta_i(), frame.theta_i, inverse->at) * (inverse->pdf / wo.z);
}

}  // namespace gonio
