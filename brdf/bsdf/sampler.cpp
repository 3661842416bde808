#include <gonio/brdf/bsdf/sampler.h>

#include <cmath>

#include <gonio/brdf/build/fit_compact.h>
#include <gonio/brdf/bsdf/frame.h>

namespace gonio {

Sampler::Sampler(std::shared_ptr<const BrdfTable> table, const Progress& progress)
    : table_(required_table(std::move(table), "sampler")),
      stack_(fit_compact(*table_, {}, progress).best().diagrams, Interpolation::blend, Storage::packed16) {}

Sampler::Sampler(std::shared_ptr<const BrdfTable> table, const StackOptions& options, const Progress& progress)
    : table_(required_table(std::move(table), "sampler")),
      stack_(build_stack(*table_, options, progress), options.interpolation, Storage::float32) {}

Sampler::Sampler(std::shared_ptr<const BrdfTable> table, const StackGrid& diagrams, Interpolation interpolation,
                 Storage storage)
    : table_(required_table(std::move(table), "sampler")), stack_(diagrams, interpolation, storage) {}

std::optional<BsdfSample> Sampler::sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
  if (!(is_above(wi) && std::isfinite(u.x + u.y))) return std::nullopt;
  const IncidentFrame frame(wi);
  const auto drawn = stack_.sample(frame.theta_i, u.x, u.y);
  if (!(drawn.pdf > 0 && drawn.wo.z > 0)) return std::nullopt;
  const glm::vec3 wo = frame.to_surface(drawn.wo);
  return BsdfSample{wo, drawn.pdf, table_->eval(wi, wo) * (wo.z / drawn.pdf)};
}

float Sampler::pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept {
  if (!(is_above(wi) && is_above(wo))) return 0;
  const IncidentFrame frame(wi);
  return stack_.pdf(frame.theta_i, frame.to_diagram(wo));
}

glm::vec3 Sampler::eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept { return table_->eval(wi, wo); }

}  // namespace gonio
