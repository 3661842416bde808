#include <cmath>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/coherence.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/samplers/stack_bsdf.h>
#include <gonio/brdf/proof/statistics/random.h>

namespace gonio::proof {
namespace {

const BrdfTable& specular_table() {
  static const BrdfTable table = [] {
    for (const GalleryTable& entry : gallery_tables())
      if (entry.name == "specular") return to_table(entry);
    throw std::logic_error("the Gallery has no specular table");
  }();
  return table;
}

std::shared_ptr<const BrdfTable> shared_table() { return {std::shared_ptr<void>(), &specular_table()}; }

// Few angles, so that the methods differ between them.
const StackGrid& coarse_grid() {
  static const StackGrid grid = [] {
    BsdfOptions options;
    options.interpolation = Interpolation::displacement;
    options.incident = 7;
    options.meridians = options.parallels = 40;
    options.budget = 480 * 1024;
    return build_stack(specular_table(), options);
  }();
  return grid;
}

StackBsdf coarse(Interpolation interpolation) { return StackBsdf({coarse_grid(), interpolation, {}}, shared_table()); }

constexpr double theta_i = 0.65;  // half way between two of the seven

TEST(Sobol, IsANet) {
  for (const std::uint32_t shift : {0u, 0xdeadbeefu}) {
    std::set<int> cells;  // 256 points: one in each of 16 x 16 cells, and in each of 256 x 1
    std::set<int> columns;
    for (std::uint32_t k = 0; k < 256; ++k) {
      const glm::vec2 p = sobol(k, shift, ~shift);
      cells.insert(static_cast<int>(p.x * 16) * 16 + static_cast<int>(p.y * 16));
      columns.insert(static_cast<int>(p.x * 256));
    }
    EXPECT_EQ(cells.size(), 256u);
    EXPECT_EQ(columns.size(), 256u);
  }
  EXPECT_LT(sobol(0xffffffffu, 0xffffffffu, 0).x, 1);
}

TEST(Coherence, TheConcentricMapKeepsShapes) {
  DiagramGrid constant;
  constant.phi = {0, pi<double>};
  constant.r = {0, 1};
  constant.density.assign(4, 1.0);
  const Stack<float> stack({{0.0}, {constant}}, Interpolation::displacement);
  const Coherence c = measure_coherence(subject_of(stack), 0.3);
  EXPECT_EQ(c.tears, 0u);
  EXPECT_EQ(c.folds, 0u);
  EXPECT_GE(c.stretch_p50, 1);
  EXPECT_LT(c.stretch_p99, 2);
}

TEST(Coherence, CountsTearsAndFolds) {
  Subject subject;
  // A square that is half turned inside out: u runs back beyond 1/2.
  subject.sample = [](const glm::vec3&, const glm::vec2& u) -> std::optional<BsdfSample> {
    const float x = u.x < 0.5f ? u.x : 1 - u.x;
    return BsdfSample{polar_to_direction(Polar<float>{0.1f + 0.8f * x, 0.2f + u.y}), 1, glm::vec3(1)};
  };
  EXPECT_GT(measure_coherence(subject, 0.3).folds, 1000u);
  subject.sample = [](const glm::vec3&, const glm::vec2& u) -> std::optional<BsdfSample> {
    const float x = u.x < 0.5f ? u.x : u.x + 0.1f;
    return BsdfSample{polar_to_direction(Polar<float>{0.1f + 0.5f * x, 0.2f + u.y}), 1, glm::vec3(1)};
  };
  const Coherence torn = measure_coherence(subject, 0.3);
  EXPECT_EQ(torn.folds, 0u);
  EXPECT_EQ(torn.tears, 64u);
}

TEST(Coherence, OnlyAMixtureIsTorn) {
  const StackBsdf displacement = coarse(Interpolation::displacement);
  const StackBsdf mixture = coarse(Interpolation::mixture);
  const Coherence d = measure_coherence(subject_of(displacement), theta_i),
                  m = measure_coherence(subject_of(mixture), theta_i);
  EXPECT_EQ(d.tears, 0u);
  EXPECT_EQ(d.folds, 0u);
  EXPECT_GT(m.tears, 50u);
  EXPECT_LT(d.stretch_p99, m.stretch_p99);
}

// What coherence buys: quasi-Monte Carlo converges faster than 1/sqrt(N) through displacement, and no
// better than random points through a method that decides by a random number of its own.
TEST(Coherence, DisplacementKeepsTheSlope) {
  const StackBsdf displacement = coarse(Interpolation::displacement);
  const Convergence c = measure_convergence(subject_of(displacement), theta_i);
  EXPECT_LT(c.qmc_slope, -0.85);
  EXPECT_NEAR(c.mc_slope, -0.5, 0.08);
  EXPECT_LT(c.qmc_error.back(), c.mc_error.back() / 20);
}

TEST(Coherence, RandomMixtureAndRejectionLoseTheSlope) {
  // A diagram at random, by the weights; then its own map.
  const Stack<float> nearest(coarse_grid(), Interpolation::nearest);
  const auto& angles = nearest.theta_i();
  std::size_t k = 0;
  while (angles[k + 1] < theta_i) ++k;
  const float alpha = (static_cast<float>(theta_i) - angles[k]) / (angles[k + 1] - angles[k]);
  Random random(7);
  const StackBsdf mixture = coarse(Interpolation::mixture);
  Subject random_mixture = subject_of(mixture);
  random_mixture.sample = [&](const glm::vec3& wi, const glm::vec2& u) -> std::optional<BsdfSample> {
    const auto s = nearest.sample(angles[random() < alpha ? k + 1 : k], u.x, u.y);
    const float pdf = mixture.pdf(wi, s.wo);
    return BsdfSample{s.wo, pdf, specular_table().eval(wi, s.wo) * (s.wo.z / pdf)};
  };
  EXPECT_GT(measure_convergence(random_mixture, theta_i, 12).qmc_slope, -0.65);

  // The first try is the point itself, the others are random.
  const StackBsdf displacement = coarse(Interpolation::displacement);
  double peak = 0;
  for (int n = 0; n < 20000; ++n)
    peak = std::max<double>(
        peak,
        displacement
            .sample({std::sin(static_cast<float>(theta_i)), 0, std::cos(static_cast<float>(theta_i))}, random.pair())
            ->pdf);
  Subject rejection = subject_of(displacement);
  rejection.sample = [&](const glm::vec3& wi, const glm::vec2& u) -> std::optional<BsdfSample> {
    for (glm::vec2 at = u;; at = random.pair()) {
      const glm::vec3 w =
          polar_to_direction(Polar<float>{std::sqrt(at.x) * (1 - 0x1p-23f), 2 * pi<float> * (at.y - 0.5f)});
      const float pdf = displacement.pdf(wi, w);
      if (random() * 1.05 * peak < pdf) return BsdfSample{w, pdf, specular_table().eval(wi, w) * (w.z / pdf)};
    }
  };
  EXPECT_GT(measure_convergence(rejection, theta_i, 10).qmc_slope, -0.65);
}

}  // namespace
}  // namespace gonio::proof
