// Proves the cosine sampler of a table.
#include <memory>

#include <gonio/brdf/proof/invariants.h>
#include <gonio/brdf/proof/samplers/baseline.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const gonio::CosineSampler sampler(std::make_shared<const gonio::BrdfTable>(gonio::load_table(argv[1])));
  gonio::proof::InvariantOptions options;
  options.draws = 1000;
  return gonio::proof::check_invariants(gonio::proof::subject_of(sampler), 0.5, options).empty() ? 1 : 0;
}
