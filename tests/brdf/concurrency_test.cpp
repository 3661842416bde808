#include <cmath>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/brdf/bsdf/bsdf.h>
#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio {
namespace {

template <class S>
double use_bsdf(const S& bsdf) {
  proof::Random random(11);
  double total = 0;
  for (int k = 0; k < 5000; ++k) {
    const float theta = 1.5f * random();
    const glm::vec3 wi(std::sin(theta), 0, std::cos(theta));
    const auto s = bsdf.sample(wi, random.pair());
    if (s) total += s->pdf + bsdf.pdf(wi, s->wo) + bsdf.eval(wi, s->wo).y;
  }
  return total;
}

double use(const StackBsdf& bsdf) { return use_bsdf(bsdf); }
double use(const Bsdf& bsdf) {
  constexpr std::size_t count = 1000;
  proof::Random random(12);
  std::vector<float> in(5 * count), out(7 * count), back(4 * count);
  for (std::size_t k = 0; k < count; ++k) {
    const float theta = 1.5f * random();
    in[k] = std::sin(theta), in[2 * count + k] = std::cos(theta), in[3 * count + k] = random(),
    in[4 * count + k] = random();
  }
  const auto arrays = [](std::vector<float>& values, std::size_t first) {
    float* const x = values.data() + first * count;
    return Arrays3{x, x + count, x + 2 * count};
  };
  bsdf.sample_n(count, arrays(in, 0), &in[3 * count], &in[4 * count], arrays(out, 0), &out[3 * count], arrays(out, 4));
  bsdf.pdf_n(count, arrays(in, 0), arrays(out, 0), &back[0]);
  bsdf.eval_n(count, arrays(in, 0), arrays(out, 0), arrays(back, 1));
  const double batches = std::accumulate(out.begin(), out.end(), 0.0) + std::accumulate(back.begin(), back.end(), 0.0);
  return use_bsdf(bsdf) + batches + bsdf.albedo(0.4f).y + bsdf.roughness();
}

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
  BsdfOptions small;
  small.interpolation = Interpolation::displacement;
  small.incident = small.meridians = small.parallels = 8;
  BsdfData data{build_stack(*table, small), Interpolation::displacement, {}};
  share(Bsdf(data, table));
  share(StackBsdf(data, table));
  const Stack<float> stack = sampled_stack(data);
  data.colour = colour_of_table(*table, direction_map(stack), {0, 0.7f, 1.5f}, 8);
  share(Bsdf(data));
  share(StackBsdf(data));
  small.chart = Chart::half, small.interpolation = Interpolation::blend;
  data = {build_stack(*table, small), Interpolation::blend, data.colour};
  share(Bsdf(data));
}

}  // namespace
}  // namespace gonio
