// The 16-bit stack, beside the benchmarks of the same names without "packed" and with "blend".
#include <benchmark/benchmark.h>

#include <gonio/mapping/stack/packed_stack.h>

#include "tools/bench/stacks.h"

namespace gonio::bench {
namespace {

constexpr std::size_t queries = 1 << 14;

void sample_packed(benchmark::State& state, Chart chart) {
  const StackGrid grid = lobe_stack(static_cast<int>(state.range(0)), 33, 33, chart);
  const PackedStack packed(grid);
  const Queries q(Stack<float>(grid, Interpolation::blend), queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = packed.sample(q.theta_i[k], q.u[k], q.v[k]);
      benchmark::DoNotOptimize(s);
    }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

void pdf_packed(benchmark::State& state, Chart chart) {
  const StackGrid grid = lobe_stack(static_cast<int>(state.range(0)), 33, 33, chart);
  const PackedStack packed(grid);
  const Queries q(Stack<float>(grid, Interpolation::blend), queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) benchmark::DoNotOptimize(packed.pdf(q.theta_i[k], q.wo(k)));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

/// A thousand stacks asked in turn.
void sample_cold_packed(benchmark::State& state) {
  constexpr std::size_t materials = 1000;
  const StackGrid grid = lobe_stack(8, 33, 33, Chart::outgoing);
  const std::vector<PackedStack> stacks(materials, PackedStack(grid));
  const Queries q(Stack<float>(grid, Interpolation::blend), queries);
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) {
      auto s = stacks[k * 619 % materials].sample(q.theta_i[k], q.u[k], q.v[k]);
      benchmark::DoNotOptimize(s);
    }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}

BENCHMARK_CAPTURE(sample_packed, outgoing, Chart::outgoing)->Arg(32);
BENCHMARK_CAPTURE(sample_packed, half, Chart::half)->Arg(32);
BENCHMARK_CAPTURE(pdf_packed, outgoing, Chart::outgoing)->Arg(32);
BENCHMARK_CAPTURE(pdf_packed, half, Chart::half)->Arg(32);
BENCHMARK(sample_cold_packed);

}  // namespace
}  // namespace gonio::bench
