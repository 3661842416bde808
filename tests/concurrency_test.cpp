#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/sampler.h>

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include <gonio/brdf/proof/random.h>

namespace gonio {
namespace {

double use(const Sampler& sampler) {
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

// Run under ThreadSanitizer by the preset tsan: samplers of both kinds are shared, and built in parallel.
TEST(Concurrency, SamplersAreShared) {
  const auto table = std::make_shared<const BrdfTable>(proof::to_table(proof::gallery_tables().front()));
  StackOptions small;
  small.incident = small.meridians = small.parallels = 8;
  const StackGrid grid = build_stack(*table, small);
  const Stack<float> stack(grid, Interpolation::displacement);
  const Sampler backed(table, grid), compact(grid, Colour::from_table(*table, stack, 8));
  for (const Sampler* sampler : {&backed, &compact}) {
    const double alone = use(*sampler);
    std::vector<double> sums(4);
    std::vector<std::thread> threads;
    for (double& sum : sums) threads.emplace_back([&sum, sampler] { sum = use(*sampler); });
    for (std::thread& thread : threads) thread.join();
    for (const double sum : sums) EXPECT_EQ(sum, alone);
  }
}

}  // namespace
}  // namespace gonio
