// Samples the table named by the argument and checks each draw against pdf() and eval().
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include <gonio/brdf/build/make_bsdf.h>
#include <gonio/brdf/table/table.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  gonio::BrdfTable table = gonio::load_table(argv[1]);
  const gonio::Bsdf bsdf = gonio::make_bsdf(std::make_shared<const gonio::BrdfTable>(std::move(table)));
  const glm::vec3 wi(0.6f, 0.0f, 0.8f);
  constexpr int n = 16;
  double albedo = 0;
  for (int i = 0; i < n * n; ++i) {
    const auto s = bsdf.sample(wi, {(i % n + 0.5f) / n, (i / n + 0.5f) / n});
    if (!s) continue;
    const glm::vec3 weight = bsdf.eval(wi, s->wo) * s->wo.z / s->pdf;
    const bool same_weight = std::abs(weight.y - s->weight.y) <= 1e-3f * s->weight.y;
    const bool same_pdf = std::abs(bsdf.pdf(wi, s->wo) - s->pdf) <= 1e-2f * s->pdf;
    if (!same_weight || !same_pdf) {
      std::fprintf(stderr, "draw %d disagrees with eval() or pdf()\n", i);
      return 1;
    }
    albedo += s->weight.y / (n * n);
  }
  std::printf("green albedo %g\n", albedo);
  return albedo > 0.01 && albedo < 1.05 ? 0 : 1;
}
