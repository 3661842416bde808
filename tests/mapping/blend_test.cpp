#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/gtest.h>
#include <gonio/brdf/value/luminance.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

/// Two diagrams on the same irregular lines.
StackGrid two_diagrams(Chart chart = Chart::outgoing, Azimuth azimuth = Azimuth::half) {
  StackGrid stack;
  stack.chart = chart;
  const double range = azimuth == Azimuth::half ? pi<double> : 2 * pi<double>;
  for (const double theta : {0.3, 0.9}) {
    DiagramGrid d;
    d.azimuth = azimuth;
    for (const double t : {0.0, 0.1, 0.45, 0.5, 0.8, 1.0}) d.phi.push_back(range * t);
    d.r = {0, 0.1, 0.35, 0.6, 0.65, 0.9, 1};
    for (const double phi : d.phi)
      for (const double r : d.r)
        d.density.push_back(std::exp(-8 * std::pow(r - theta, 2)) *
                                (1.1 - 0.5 * std::cos(phi) + theta * std::cos(2 * phi)) +
                            0.02 + (theta > 0.5 ? 0 : r));
    if (azimuth == Azimuth::full)
      for (std::size_t j = 0; j < d.r.size(); ++j) d.at(d.phi.size() - 1, j) = d.at(0, j);
    stack.theta_i.push_back(theta);
    stack.diagrams.push_back(std::move(d));
  }
  return stack;
}

// The blend of the diagrams' maps is the map of the blended diagram.
TEST(Blend, IsTheDiagramOfTheBlendedDensities) {
  for (const Azimuth azimuth : {Azimuth::half, Azimuth::full}) {
    const StackGrid grid = two_diagrams(Chart::outgoing, azimuth);
    const Diagram<double> a(grid.diagrams[0]), b(grid.diagrams[1]);
    for (const double alpha : {0.0, 0.25, 0.7, 1.0}) {
      DiagramGrid mixed = a.grid();
      for (std::size_t k = 0; k < mixed.density.size(); ++k)
        mixed.density[k] = (1 - alpha) * mixed.density[k] + alpha * b.grid().density[k];
      const Diagram<double> right(mixed);
      const Blend<double> blend(a, b, alpha);
      for (double u = 0; u <= 1; u += 0.03125) {
        for (double v = 0; v <= 1; v += 0.03125) {
          const auto expected = right.sample(u, v);
          const auto s = blend.sample(u, v, 1 - v);
          ASSERT_NEAR(s.at.phi, expected.at.phi, 1e-12);
          ASSERT_NEAR(s.at.r, expected.at.r, 1e-12);
          ASSERT_NEAR(s.pdf, expected.pdf, 1e-12);
          ASSERT_NEAR(blend.pdf(s.at), expected.pdf, 1e-12);
          const auto back = blend.invert(s.at);
          ASSERT_NEAR(back.u, u, 1e-12);
          ASSERT_NEAR(back.v, v, 1e-12);
          ASSERT_NEAR(back.pdf, expected.pdf, 1e-12);
        }
      }
    }
  }
}

TEST(Blend, NeedsSharedLines) {
  StackGrid grid = two_diagrams();
  grid.diagrams[1].r[3] = 0.61;
  EXPECT_THROW(Stack<float>(grid, Interpolation::blend), Error);
  EXPECT_NO_THROW(Stack<float>(grid, Interpolation::displacement));
}

// The pdf of any interpolation in either chart is the inverse of the area that the map gives to a small
// square, by differences of directions alone.
TEST(Charts, PdfIsTheJacobianOfTheMap) {
  for (const Chart chart : charts) {
    for (const Interpolation interpolation :
         {Interpolation::nearest, Interpolation::displacement, Interpolation::blend}) {
      const Stack<long double> stack(two_diagrams(chart), interpolation);
      std::mt19937 engine(1);
      std::uniform_real_distribution<double> random;
      constexpr long double h = 1e-6L;
      int good = 0;
      constexpr int count = 2000;
      for (int k = 0; k < count; ++k) {
        const long double theta_i = 0.2 + random(engine), u = h + (1 - 2 * h) * random(engine),
                          v = h + (1 - 2 * h) * random(engine);
        const auto s = stack.sample(theta_i, u, v);
        const auto a = (stack.sample(theta_i, u + h, v).wo - stack.sample(theta_i, u - h, v).wo) / (2 * h);
        const auto b = (stack.sample(theta_i, u, v + h).wo - stack.sample(theta_i, u, v - h).wo) / (2 * h);
        const Vec3<long double> n(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
        good += std::abs(s.pdf * std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) - 1) < 1e-3L;
      }
      EXPECT_GT(good, count - 20) << to_string(chart) << ' '
                                  << to_string(interpolation);  // lines bend the map within h
    }
  }
}

TEST(Charts, HalfVectorStacksFillTheHemisphere) {
  for (const Interpolation interpolation : interpolations) {
    const Stack<double> stack(two_diagrams(Chart::half), interpolation);
    for (const double theta_i : {0.0, 0.5, 1.2}) {
      double sum = 0;
      constexpr int side = 300;
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          const Polar<double> p{(j + 0.5) / side, pi<double> * (2 * (i + 0.5) / side - 1)};
          sum += stack.pdf(theta_i, polar_to_direction(p)) * 2 * p.r / side * 2 * pi<double> / side;
        }
      EXPECT_NEAR(sum, 1, 5e-3) << to_string(interpolation) << " at " << theta_i;
    }
  }
}

proof::InvariantOptions invariant_options() {
  proof::InvariantOptions options;
  options.runs = 1000;
  options.draws = 40000;
  options.points = 400;
  // At the rim the density falls to 0 and r changes by the square root of the rounding of v: of the
  // sums over four rows in a blend.
  options.direction_bound = 2e-3;
  return options;
}

const proof::GalleryTable& gallery_table(const std::string& name) {
  static const auto tables = proof::gallery_tables();
  for (const auto& entry : tables)
    if (entry.name == name) return entry;
  throw std::logic_error("the Gallery has no table " + name);
}

StackGrid half_vector_stack(const BrdfTable& table, std::size_t budget) {
  BsdfOptions options;
  options.chart = Chart::half;
  options.meridians = options.parallels = 40;
  options.budget = budget;
  return build_stack(table, options);
}

// No energy is lost at the horizon: the mean weight is the albedo by quadrature, at every angle.
TEST(HalfVectorStack, KeepsTheEnergy) {
  const auto table = std::make_shared<const BrdfTable>(to_table(gallery_table("asymmetric")));
  const Bsdf bsdf({half_vector_stack(*table, 64 * 1024), Interpolation::blend, {}}, table);
  for (const double degrees : {2, 10, 30, 50, 70, 80, 85, 89}) {
    const auto q = proof::measure(proof::subject_of(bsdf), degrees * pi<double> / 180);
    EXPECT_NEAR(luminance(glm::vec3(q.albedo)) / luminance(glm::vec3(q.albedo_table)), 1, 5e-4) << degrees;
    EXPECT_EQ(q.invalid_fraction, 0) << degrees;
  }
}

TEST(HalfVectorStack, SelfContainedAgreesWithItself) {
  const auto table = std::make_shared<const BrdfTable>(to_table(gallery_table("asymmetric")));
  BsdfData data{half_vector_stack(*table, 32 * 1024), Interpolation::blend, {}};
  const Stack<float> stack = sampled_stack(data);
  data.colour = colour_of_table(*table, direction_map(stack), stack.theta_i(), 16);
  const Bsdf bsdf(data);
  const StackBsdf plain(data);
  proof::InvariantOptions invariants = invariant_options();
  // Towards the horizon the density falls to 0 in the last ulps of r, and its relative error rises.
  invariants.density_floor = 1e-2;
  invariants.weight_bound = 1e-3;
  for (const double theta_i : {0.3, 0.9}) {
    EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(proof::subject_of(plain), theta_i, invariants);
    EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(proof::subject_of(bsdf), theta_i, invariants);
  }
}

}  // namespace
}  // namespace gonio
