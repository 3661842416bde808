#include <gonio/brdf/bsdf/sampler.h>
#include <gonio/brdf/table/table.h>

#include <glm/mat3x3.hpp>
#include <memory>

// Once per material. The sampler is immutable: all threads share it.
gonio::Sampler load_material(const std::filesystem::path& path) {
  return gonio::Sampler(std::make_shared<const gonio::BrdfTable>(gonio::load_table(path)));
}

// One bounce at a hit. `frame` has the tangent, bitangent and normal as columns; `u` is two uniform
// numbers in [0, 1). Returns false where the path ends.
bool bounce(const gonio::Sampler& material, const glm::mat3& frame, const glm::vec2& u,
            glm::vec3& direction, glm::vec3& throughput, float& pdf) {
  const glm::vec3 wi = -direction * frame;  // to the local frame, away from the surface
  const auto s = material.sample(wi, u);
  if (!s) return false;
  throughput *= s->weight;  // f_r cos(theta_o) / pdf
  pdf = s->pdf;             // per solid angle, for multiple importance sampling
  direction = frame * s->wo;
  return true;
}

// The same hit lit from the local direction `wo` that a light proposed with `light_pdf`.
glm::vec3 direct(const gonio::Sampler& material, const glm::vec3& wi, const glm::vec3& wo,
                 const glm::vec3& radiance, float light_pdf) {
  const float balance = light_pdf + material.pdf(wi, wo);
  return wo.z > 0 ? material.eval(wi, wo) * wo.z * radiance / balance : glm::vec3(0);
}
