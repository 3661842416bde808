// Stores the BSDF of the table named by the argument beside it and samples it as loaded; then
// evaluates a sum of analytic lobes.
#include <gonio/brdf/exr/stack_file.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/fitting/model/model.h>

#include <cstdio>
#include <memory>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto table = std::make_shared<const gonio::BrdfTable>(gonio::load_table(argv[1]));
  const std::string path = std::string(argv[1]) + ".exr";
  gonio::StackFile file;
  file.bsdf = gonio::fit_compact(*table).best().data;
  file.name = table->info().name;
  gonio::save_stack(path, file);

  const glm::vec3 wi(0.6f, 0.0f, 0.8f);
  const gonio::Bsdf bsdf = gonio::load_bsdf(path);
  const auto s = bsdf.sample(wi, {0.25f, 0.5f});
  const gonio::LobeModel model = gonio::parse_model("ggx:alpha=0.2+lambert:albedo=0.5");
  const double f = model.eval(glm::dvec3(wi), glm::dvec3(0, 0, 1)).y;
  std::printf("pdf %g, f_r of the lobes %g 1/sr\n", s ? s->pdf : 0, f);
  return s && s->pdf > 0 && f > 0 ? 0 : 1;
}
