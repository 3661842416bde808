#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/bsdf/compact_bsdf.h>
#include <gonio/brdf/bsdf/sampler.h>

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/stack/packed_stack.h>

namespace gonio {
namespace {

double use(const PackedStack& stack) {
  proof::Random random(11);
  double total = 0;
  for (int k = 0; k < 5000; ++k) {
    const float theta = 1.5f * random();
    const glm::vec2 u = random.pair();
    const auto s = stack.sample(theta, u.x, u.y);
    total += s.pdf + stack.pdf(theta, s.wo) + stack.invert(theta, s.wo).has_value();
  }
  return total;
}

template <class S>
double use_bsdf(const S& sampler) {
  proof::Random random(11);
  double total = 0;
  for (int k = 0; k < 5000; ++k) {
    const float theta = 1.5f * random();
    const glm::vec3 wi(std::sin(theta), 0, std::cos(theta));
    const auto s = sampler.sample(wi, random.pair());
    if (s) total += s->pdf + sampler.pdf(wi, s->wo) + sampler.eval(wi, s->wo).y;
  }
  return total;
}

double use(const Sampler& sampler) { return use_bsdf(sampler); }
double use(const CompactBsdf& sampler) { return use_bsdf(sampler); }

/// The same from four threads at once as alone.
template <class S>
void share(const S& sampler) {
  const double alone = use(sampler);
  std::vector<double> sums(4);
  std::vector<std::thread> threads;
  for (double& sum : sums) threads.emplace_back([&sum, &sampler] { sum = use(sampler); });
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(sum, alone);
}

// Run under ThreadSanitizer by the preset tsan: samplers of every kind are shared, and built in parallel.
TEST(Concurrency, SamplersAreShared) {
  const auto table = std::make_shared<const BrdfTable>(proof::to_table(proof::gallery_tables().front()));
  StackOptions small;
  small.incident = small.meridians = small.parallels = 8;
  const StackGrid grid = build_stack(*table, small);
  const Stack<float> stack(grid, Interpolation::displacement);
  const Colour colour = Colour::from_table(*table, direction_map(stack), {0, 0.7f, 1.5f}, 8);
  share(Sampler(table, grid));
  share(CompactBsdf(grid, Interpolation::displacement, Storage::float32, colour));
  small.chart = Chart::half, small.interpolation = Interpolation::blend;
  const StackGrid shared_lines = build_stack(*table, small);
  share(PackedStack(shared_lines));
  share(CompactBsdf(shared_lines, Interpolation::blend, Storage::packed16, colour));
}

}  // namespace
}  // namespace gonio
