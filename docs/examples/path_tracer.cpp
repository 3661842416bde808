#include <memory>

#include <glm/mat3x3.hpp>

#include <gonio/brdf/build/make_bsdf.h>
#include <gonio/brdf/exr/stack_file.h>  // gonio::exr

// Once per material, of what `gonio convert` wrote: milliseconds. A Bsdf is immutable: all threads share it.
gonio::Bsdf load_material(const std::filesystem::path& path) { return gonio::load_bsdf(path); }

// Or of the measured table, which stays in memory and has f_r exactly: seconds.
gonio::Bsdf make_material(const std::filesystem::path& path) {
  return gonio::make_bsdf(std::make_shared<const gonio::BrdfTable>(gonio::load_table(path)));
}

// One bounce at a hit. `frame` has the tangent, bitangent and normal as columns; `u` is two uniform
// numbers in [0, 1). Returns false where the path ends.
bool bounce(const gonio::Bsdf& material, const glm::mat3& frame, const glm::vec2& u, glm::vec3& direction,
            glm::vec3& throughput, float& pdf) {
  const glm::vec3 wi = -direction * frame;  // to the local frame, away from the surface
  const auto s = material.sample(wi, u);
  if (!s) return false;
  throughput *= s->weight;  // f_r cos(theta_o) / pdf
  pdf = s->pdf;             // per solid angle, for multiple importance sampling
  direction = frame * s->wo;
  return true;
}

// The same hit lit from the local direction `wo` that a light proposed with `light_pdf`.
glm::vec3 direct(const gonio::Bsdf& material, const glm::vec3& wi, const glm::vec3& wo, const glm::vec3& radiance,
                 float light_pdf) {
  const float balance = light_pdf + material.pdf(wi, wo);
  return wo.z > 0 ? material.eval(wi, wo) * wo.z * radiance / balance : glm::vec3(0);
}
