// Measured tables: the files of RGL that GONIO_TEST_DATA has (none: these are skipped), and a table in the layout of MERL.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <memory>
#include <string>

#include <gonio/brdf/baseline.h>
#include <gonio/brdf/proof/random.h>
#include <gonio/brdf/sampler.h>
#include <gonio/brdf/write.h>

namespace gonio::bench {
namespace {

constexpr std::size_t queries = 1 << 12;

/// Null, with the state told so, where the folder is not known.
std::shared_ptr<const BrdfTable> rgl(benchmark::State& state) {
  const char* folder = std::getenv("GONIO_TEST_DATA");
  if (folder == nullptr) {
    state.SkipWithError("GONIO_TEST_DATA is not set");
    return nullptr;
  }
  return std::make_shared<const BrdfTable>(load_table(std::string(folder) + "/rgl/satin_rosaline_rgb.bsdf"));
}

struct Directions {
  std::vector<glm::vec3> wi, wo;
  std::vector<glm::vec2> u;
  explicit Directions(const std::shared_ptr<const BrdfTable>& table) {
    proof::Random random(1);
    const CosineSampler cosine(table);
    for (std::size_t k = 0; k < queries; ++k) {
      wi.push_back(cosine.sample({0, 0, 1}, random.pair())->wo);
      wo.push_back(cosine.sample({0, 0, 1}, random.pair())->wo);
      u.push_back(random.pair());
    }
  }
};

template <class S>
void draw(benchmark::State& state, const S& sampler, const Directions& d) {
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = sampler.sample(d.wi[k], d.u[k]);
      benchmark::DoNotOptimize(s);
    }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

void rgl_sample(benchmark::State& state) {
  if (const auto table = rgl(state)) draw(state, RglSampler(table), Directions(table));
}

void evaluate(benchmark::State& state, const std::shared_ptr<const BrdfTable>& table) {
  const Directions d(table);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) benchmark::DoNotOptimize(table->eval(d.wi[k], d.wo[k]));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

void rgl_eval(benchmark::State& state) {
  if (const auto table = rgl(state)) evaluate(state, table);
}

void rgl_load(benchmark::State& state) {
  for (auto _ : state)
    if (!rgl(state)) return;
}

void rgl_to_merl(benchmark::State& state) {
  const auto table = rgl(state);
  if (!table) return;
  for (auto _ : state) benchmark::DoNotOptimize(sample_as_merl(*table));
}

BENCHMARK(rgl_sample);
BENCHMARK(rgl_eval);
BENCHMARK(rgl_load)->Unit(benchmark::kMillisecond);
BENCHMARK(rgl_to_merl)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace gonio::bench
