#include <cstdio>

#include <gonio/brdf/exr/stack_file.h>

int main() {
  const gonio::Bsdf material = gonio::load_bsdf("data/materials/satin_rosaline.exr");
  const glm::vec3 wi(0.6f, 0.0f, 0.8f);               // local frame, normal +z, away from the surface
  const auto s = material.sample(wi, {0.25f, 0.5f});  // wo, pdf [1/sr], weight = f_r cos(theta_o) / pdf
  if (!s) return 1;
  const glm::vec3 f_r = material.eval(wi, s->wo);  // [1/sr], without the cosine
  std::printf("%.3f = %.3f\n", s->weight.g, f_r.g * s->wo.z / material.pdf(wi, s->wo));
}
