// Makes the BSDF of the table named by the argument, stores it beside the table and samples it as loaded.
#include <memory>
#include <string>

#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/exr/stack_file.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const gonio::BrdfTable table = gonio::load_table(argv[1]);
  const std::string path = std::string(argv[1]) + ".exr";
  gonio::StackFile file;
  file.bsdf = gonio::fit_compact(table).best().data;
  file.name = table.info().name;
  gonio::save_stack(path, file);
  const auto s = gonio::load_bsdf(path).sample({0.6f, 0.0f, 0.8f}, {0.25f, 0.5f});
  return s && s->pdf > 0 ? 0 : 1;
}
