// One diagram and stacks, scalar and batch: what a look-up costs.
#include <array>
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include <gonio/brdf/batch/batch_stack.h>

#include "tools/bench/stacks.h"

namespace gonio::bench {
namespace {

constexpr std::size_t queries = 1 << 14;

void per_item(benchmark::State& state, std::size_t items) {
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * items));
}

/// Forward maps (u, v) to direction and pdf of one diagram, the Halton numbers (2, 3) made within as the paper does.
void forward_halton(benchmark::State& state) {
  const Stack<float> stack(lobe_stack(1, 11, 8, Chart::outgoing), Interpolation::nearest);
  for (auto _ : state)
    for (std::uint32_t k = 0; k < queries; ++k) {
      auto s = stack.sample(0.5f, halton(k, 2), halton(k, 3));
      benchmark::DoNotOptimize(s);
    }
  per_item(state, queries);
}

void forward(benchmark::State& state) {
  const Stack<float> stack(
      lobe_stack(1, static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), Chart::outgoing),
      Interpolation::nearest);
  const Queries q(stack, queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = stack.sample(0.5f, q.u[k], q.v[k]);
      benchmark::DoNotOptimize(s);
    }
  per_item(state, queries);
}

void inverse(benchmark::State& state) {
  const Stack<float> stack(
      lobe_stack(1, static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), Chart::outgoing),
      Interpolation::nearest);
  const Queries q(stack, queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = stack.invert(0.5f, q.wo(k));
      benchmark::DoNotOptimize(s);
    }
  per_item(state, queries);
}

void forward_batch(benchmark::State& state) {
  const Stack<float> stack(
      lobe_stack(1, static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), Chart::outgoing),
      Interpolation::nearest);
  const BatchStack batch(stack);
  Queries q(stack, queries);
  for (auto _ : state)
    batch.sample_n(queries, q.theta_i.data(), q.u.data(), q.v.data(), q.x.data(), q.y.data(), q.z.data(), q.pdf.data());
  per_item(state, queries);
}

void inverse_batch(benchmark::State& state) {
  const Stack<float> stack(
      lobe_stack(1, static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), Chart::outgoing),
      Interpolation::nearest);
  const BatchStack batch(stack);
  Queries q(stack, queries);
  for (auto _ : state)
    batch.invert_n(queries, q.theta_i.data(), q.x.data(), q.y.data(), q.z.data(), q.u.data(), q.v.data(), q.pdf.data());
  per_item(state, queries);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->Args({11, 8});
  for (const int side : {4, 8, 16, 32, 64, 128}) b->Args({side, side});
}
BENCHMARK(forward_halton);
BENCHMARK(forward)->Apply(sizes);
BENCHMARK(inverse)->Apply(sizes);
BENCHMARK(forward_batch)->Apply(sizes);
BENCHMARK(inverse_batch)->Apply(sizes);

void sample(benchmark::State& state, Interpolation interpolation, Chart chart) {
  const Stack<float> stack(lobe_stack(static_cast<int>(state.range(0)), 33, 33, chart), interpolation);
  const Queries q(stack, queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = stack.sample(q.theta_i[k], q.u[k], q.v[k]);
      benchmark::DoNotOptimize(s);
    }
  per_item(state, queries);
}

void pdf(benchmark::State& state, Interpolation interpolation, Chart chart) {
  const Stack<float> stack(lobe_stack(static_cast<int>(state.range(0)), 33, 33, chart), interpolation);
  const Queries q(stack, queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) benchmark::DoNotOptimize(stack.pdf(q.theta_i[k], q.wo(k)));
  per_item(state, queries);
}

void invert(benchmark::State& state, Interpolation interpolation, Chart chart) {
  const Stack<float> stack(lobe_stack(static_cast<int>(state.range(0)), 33, 33, chart), interpolation);
  const Queries q(stack, queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = stack.invert(q.theta_i[k], q.wo(k));
      benchmark::DoNotOptimize(s);
    }
  per_item(state, queries);
}

/// Arguments: diagrams, batch size.
enum class Call { sample, pdf, invert };
void batch(benchmark::State& state, Call call, Interpolation interpolation, Chart chart) {
  const Stack<float> stack(lobe_stack(static_cast<int>(state.range(0)), 33, 33, chart), interpolation);
  const BatchStack many(stack);
  Queries q(stack, queries);
  const std::size_t size = static_cast<std::size_t>(state.range(1));
  for (auto _ : state)
    for (std::size_t k = 0; k + size <= queries; k += size) {
      const float* theta_i = q.theta_i.data() + k;
      float *u = q.u.data() + k, *v = q.v.data() + k, *x = q.x.data() + k, *y = q.y.data() + k, *z = q.z.data() + k,
            *p = q.pdf.data() + k;
      if (call == Call::sample) many.sample_n(size, theta_i, u, v, x, y, z, p);
      if (call == Call::pdf) many.pdf_n(size, theta_i, x, y, z, p);
      if (call == Call::invert) many.invert_n(size, theta_i, x, y, z, u, v, p);
    }
  per_item(state, queries / size * size);
}

/// A thousand stacks asked in turn: every look-up finds its stack out of the near caches.
void sample_cold(benchmark::State& state, Interpolation interpolation) {
  constexpr std::size_t materials = 1000;
  const Stack<float> stack(lobe_stack(8, 33, 33, Chart::outgoing), interpolation);
  const std::vector<Stack<float>> stacks(materials, stack);
  const Queries q(stack, queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = stacks[k * 619 % materials].sample(q.theta_i[k], q.u[k], q.v[k]);
      benchmark::DoNotOptimize(s);
    }
  per_item(state, queries);
}
/// The same in batches of 64, as a wavefront that is sorted by material has them.
void batch_cold(benchmark::State& state, Interpolation interpolation) {
  constexpr std::size_t materials = 1000, size = 64;
  const Stack<float> stack(lobe_stack(8, 33, 33, Chart::outgoing), interpolation);
  const std::vector<BatchStack> stacks(materials, BatchStack(stack));
  Queries q(stack, queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; k += size)
      stacks[k / size * 619 % materials].sample_n(size, q.theta_i.data() + k, q.u.data() + k, q.v.data() + k,
                                                  q.x.data() + k, q.y.data() + k, q.z.data() + k, q.pdf.data() + k);
  per_item(state, queries);
}

const int registered = [] {
  const auto diagrams = [](auto* b) {
    for (const int count : {2, 8, 32, 128}) b->Arg(count);
  };
  for (const Chart chart : charts)
    for (const Interpolation i : interpolations) {
      const std::string name = std::string("/") + to_string(i) + "/" + to_string(chart);
      diagrams(benchmark::RegisterBenchmark(("sample" + name).c_str(), sample, i, chart));
      diagrams(benchmark::RegisterBenchmark(("pdf" + name).c_str(), pdf, i, chart));
      diagrams(benchmark::RegisterBenchmark(("invert" + name).c_str(), invert, i, chart));
      if (i == Interpolation::mixture) continue;
      for (const auto& [call, verb] :
           {std::pair{Call::sample, "sample"}, {Call::pdf, "pdf"}, {Call::invert, "invert"}}) {
        auto* b = benchmark::RegisterBenchmark((std::string(verb) + "_batch" + name).c_str(), batch, call, i, chart);
        for (const int count : {2, 8, 32, 128}) b->Args({count, 4096});
        for (const int size : {1, 16, 64, 256}) b->Args({32, size});
      }
    }
  for (const Interpolation i : {Interpolation::displacement, Interpolation::blend}) {
    benchmark::RegisterBenchmark((std::string("sample_cold/") + to_string(i)).c_str(), sample_cold, i);
    benchmark::RegisterBenchmark((std::string("sample_batch_cold/") + to_string(i)).c_str(), batch_cold, i);
  }
  return 0;
}();

}  // namespace
}  // namespace gonio::bench
