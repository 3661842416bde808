// Tables: a file of RGL that GONIO_TEST_DATA has (none: skipped), made-up ones in the layouts of MERL and MBSDF, and
// BSDFs with RGB weights, in plain scalar code, one at a time and in batches, self-contained and backed by a table.
#include <cstdlib>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/brdf/resample/table_resample.h>

#include "tools/bench/stacks.h"

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

/// The same by BrdfTable::eval_n().
void evaluate_batch(benchmark::State& state, const std::shared_ptr<const BrdfTable>& table) {
  const Directions d(table);
  std::vector<float> a[9];
  for (auto& array : a) array.resize(queries);
  for (std::size_t k = 0; k < queries; ++k)
    for (int c = 0; c < 3; ++c) a[c][k] = d.wi[k][c], a[3 + c][k] = d.wo[k][c];
  const Arrays3 rgb{a[6].data(), a[7].data(), a[8].data()};
  for (auto _ : state) {
    table->eval_n(queries, {a[0].data(), a[1].data(), a[2].data()}, {a[3].data(), a[4].data(), a[5].data()}, rgb);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

void rgl_eval(benchmark::State& state) {
  if (const auto table = rgl(state)) evaluate(state, table);
}
void rgl_eval_batch(benchmark::State& state) {
  if (const auto table = rgl(state)) evaluate_batch(state, table);
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

const BrdfTable& made_grid() {
  static const BrdfTable table = to_table(proof::gallery_tables().front());
  return table;
}
std::shared_ptr<const BrdfTable> shared_grid() { return std::make_shared<const BrdfTable>(made_grid()); }
const std::shared_ptr<const BrdfTable>& made_merl() {
  static const auto table =
      std::make_shared<const BrdfTable>(MerlTable(sample_as_merl(made_grid()), {}), BrdfTable::Info{});
  return table;
}
void grid_eval(benchmark::State& state) { evaluate(state, shared_grid()); }
void grid_eval_batch(benchmark::State& state) { evaluate_batch(state, shared_grid()); }
void merl_eval(benchmark::State& state) { evaluate(state, made_merl()); }
void merl_eval_batch(benchmark::State& state) { evaluate_batch(state, made_merl()); }

/// A self-contained stack of 32 diagrams of 33 x 33 lines with 8 x 4 colours each.
BsdfData coloured(Interpolation interpolation, Chart chart) {
  const StackGrid grid = lobe_stack(32, 33, 33, chart);
  std::vector<float> theta_i;
  for (const double theta : grid.theta_i) theta_i.push_back(static_cast<float>(theta));
  return {grid, interpolation, Colour(theta_i, 8, std::vector<glm::vec3>(32 * 32, glm::vec3(0.5f, 0.4f, 0.3f)))};
}

enum class Call { sample, pdf, eval };

template <class S>
void one_by_one(benchmark::State& state, Call call, const S& sampler) {
  Directions d(std::make_shared<const BrdfTable>(made_grid()));
  if (call == Call::sample) return draw(state, sampler, d);
  for (std::size_t k = 0; k < queries; ++k)
    if (const auto s = sampler.sample(d.wi[k], d.u[k])) d.wo[k] = s->wo;
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      if (call == Call::pdf) benchmark::DoNotOptimize(sampler.pdf(d.wi[k], d.wo[k]));
      if (call == Call::eval) benchmark::DoNotOptimize(sampler.eval(d.wi[k], d.wo[k]));
    }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

void in_batches(benchmark::State& state, Call call, const Bsdf& bsdf) {
  const Directions d(std::make_shared<const BrdfTable>(made_grid()));
  std::vector<float> a[12];
  for (auto& array : a) array.resize(queries);
  for (std::size_t k = 0; k < queries; ++k) {
    for (int c = 0; c < 3; ++c) a[c][k] = d.wi[k][c];
    a[3][k] = d.u[k].x, a[4][k] = d.u[k].y;
  }
  const Arrays3 wi{a[0].data(), a[1].data(), a[2].data()}, wo{a[5].data(), a[6].data(), a[7].data()},
      rgb{a[9].data(), a[10].data(), a[11].data()};
  bsdf.sample_n(queries, wi, a[3].data(), a[4].data(), wo, a[8].data(), rgb);
  for (auto _ : state) {
    if (call == Call::sample) bsdf.sample_n(queries, wi, a[3].data(), a[4].data(), wo, a[8].data(), rgb);
    if (call == Call::pdf) bsdf.pdf_n(queries, wi, wo, a[8].data());
    if (call == Call::eval) bsdf.eval_n(queries, wi, wo, rgb);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

/// By StackBsdf; by Bsdf, one at a time and in batches.
enum class Form { scalar, one, batch };
constexpr std::pair<Form, const char*> forms[] = {{Form::scalar, "_scalar"}, {Form::one, ""}, {Form::batch, "_batch"}};
void look_up(benchmark::State& state, Form form, Call call, const BsdfData& data,
             const std::shared_ptr<const BrdfTable>& table = nullptr) {
  if (form == Form::scalar) one_by_one(state, call, StackBsdf(data, table));
  if (form == Form::one) one_by_one(state, call, Bsdf(data, table));
  if (form == Form::batch) in_batches(state, call, Bsdf(data, table));
}

/// The file of RGL that rgl_sample() has, as make_bsdf() makes it: with its table's f_r or with colours of its own.
void rgl_bsdf(benchmark::State& state, Form form, BsdfValue value) {
  const auto table = rgl(state);
  if (!table) return;
  static const BsdfData data = fit_compact(*table).best().data;
  look_up(state, form, Call::sample, data, value == BsdfValue::table ? table : nullptr);
}
/// A table of MERL's layout with its f_r.
void merl_bsdf(benchmark::State& state, Form form) {
  static const BsdfData data = fit_compact(*made_merl()).best().data;
  look_up(state, form, Call::sample, data, made_merl());
}
/// A displacement stack with colours of its own.
void rgl_displacement(benchmark::State& state, Form form) {
  const auto table = rgl(state);
  if (!table) return;
  static const BsdfData data = [&] {
    BsdfOptions options;
    options.interpolation = Interpolation::displacement;
    options.meridians = options.parallels = 40;
    options.budget = 480 * 1024;
    BsdfData made{build_stack(*table, options), options.interpolation, {}};
    const Stack<float> stack = sampled_stack(made);
    made.colour = colour_of_table(*table, direction_map(stack), stack.theta_i(), 8);
    return made;
  }();
  look_up(state, form, Call::sample, data);
}

/// One draw at a time from 1,000 materials in turn, as a path tracer meets them: nothing that is read is in a cache.
void bsdf_cold(benchmark::State& state, Interpolation interpolation, Chart chart) {
  constexpr std::size_t materials = 1000;
  const BsdfData data = coloured(interpolation, chart);
  std::vector<Bsdf> bsdfs;
  for (std::size_t k = 0; k < materials; ++k) bsdfs.emplace_back(data);
  const Directions d(std::make_shared<const BrdfTable>(made_grid()));
  std::size_t n = 0;
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k, ++n)
      benchmark::DoNotOptimize(bsdfs[n * 619 % materials].sample(d.wi[k], d.u[k]));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

const int registered = [] {
  for (const auto& [interpolation, chart] :
       {std::pair{Interpolation::displacement, Chart::outgoing}, {Interpolation::blend, Chart::half}}) {
    const std::string name = std::string("/") + to_string(interpolation) + "/" + to_string(chart);
    benchmark::RegisterBenchmark(("rgb_sample_cold" + name).c_str(), bsdf_cold, interpolation, chart);
    for (const auto& [call, verb] : {std::pair{Call::sample, "sample"}, {Call::pdf, "pdf"}, {Call::eval, "eval"}})
      for (const auto& [form, end] : forms)
        benchmark::RegisterBenchmark((std::string("rgb_") + verb + end + name).c_str(),
                                     [i = interpolation, c = chart, o = call, f = form](benchmark::State& state) {
                                       look_up(state, f, o, coloured(i, c));
                                     });
  }
  for (const auto& [form, end] : forms) {
    benchmark::RegisterBenchmark((std::string("rgl_table_sample") + end).c_str(), rgl_bsdf, form, BsdfValue::table);
    benchmark::RegisterBenchmark((std::string("merl_table_sample") + end).c_str(), merl_bsdf, form);
    benchmark::RegisterBenchmark((std::string("rgl_colour_sample") + end).c_str(), rgl_bsdf, form, BsdfValue::colour);
    benchmark::RegisterBenchmark((std::string("rgl_displacement_sample") + end).c_str(), rgl_displacement, form);
  }
  return 0;
}();

BENCHMARK(rgl_sample);
BENCHMARK(rgl_eval);
BENCHMARK(rgl_eval_batch);
BENCHMARK(merl_eval);
BENCHMARK(merl_eval_batch);
BENCHMARK(grid_eval);
BENCHMARK(grid_eval_batch);
BENCHMARK(rgl_load)->Unit(benchmark::kMillisecond);
BENCHMARK(rgl_to_merl)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace gonio::bench
