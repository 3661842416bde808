#include <gonio/brdf/bsdf/compact_bsdf.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/gtest.h>
#include <gonio/mapping/base/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace gonio {
namespace {

BrdfTable gallery_table(const std::string& name) {
  for (const auto& entry : proof::gallery_tables())
    if (entry.name == name) return proof::to_table(entry);
  throw std::logic_error("the Gallery has no table " + name);
}

const CompactChoice& asymmetric_fit() {
  static const CompactChoice fit = [] {
    CompactOptions options;
    options.max_variance = 0.01;
    return fit_compact(gallery_table("asymmetric"), options);
  }();
  return fit;
}

// Everything that the optimiser emits is a sampler without fault, 16-bit storage included.
TEST(CompactBsdf, InvariantsHoldOnWhatIsFitted) {
  const CompactBsdf bsdf = asymmetric_fit().best().bsdf();
  EXPECT_EQ(bsdf.stack().storage(), Storage::packed16);
  proof::InvariantOptions options;
  options.runs = 10;
  options.direction_bound = 1e-3;
  // f_r is W pdf / cos theta_o: towards the horizon as exact as the pdf is there.
  options.density_floor = 1e-2;
  options.weight_bound = 2e-3;
  for (const double theta_i : {0.0, 0.3, 0.9, 1.3})
    EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(proof::subject_of(bsdf), theta_i, options);
}

TEST(CompactBsdf, NothingBelowTheHorizon) {
  const CompactBsdf bsdf = asymmetric_fit().best().bsdf();
  const glm::vec3 up(0.6f, 0, 0.8f), down(0.6f, 0, -0.8f);
  EXPECT_FALSE(bsdf.sample(down, {0.5f, 0.5f}));
  EXPECT_EQ(bsdf.pdf(down, up), 0);
  EXPECT_EQ(bsdf.pdf(up, down), 0);
  EXPECT_EQ(bsdf.eval(up, down), glm::vec3(0));
  EXPECT_EQ(bsdf.eval(down, up), glm::vec3(0));
}

TEST(CompactBsdf, RefusesWhatItCannotHold) {
  const CompactFit& fit = asymmetric_fit().best();
  EXPECT_THROW(CompactBsdf(fit.diagrams, Interpolation::displacement, Storage::packed16, fit.colour), Error);
  EXPECT_THROW(CompactBsdf(fit.diagrams, Interpolation::blend, Storage::packed16, {}), Error);
}

TEST(Colour, KeepsItsValues) {
  const std::vector<glm::vec3> values{{1, 0, 100}, {0.001f, 3, 1e-9f}};
  const Colour colour({0.2f}, 2, values);
  const std::vector<glm::vec3> held = colour.values();
  for (std::size_t k = 0; k < 2; ++k)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(held[k][c], values[k][c], values[k][c] / 2048 + 100 * 0x1p-40f);
  EXPECT_EQ(Colour({0.2f}, 2, held).values(), held);
}

TEST(Colour, LinearBetweenItsAngles) {
  const Colour colour({0.2f, 1.0f}, 2, {{1, 1, 1}, {1, 1, 1}, {3, 3, 3}, {3, 3, 3}});
  EXPECT_NEAR(colour.eval(0.6f, {0.4f, 0.7f}).x, 2, 1e-3);
  EXPECT_NEAR(colour.eval(0.0f, {0.4f, 0.7f}).x, 1, 1e-3);
  EXPECT_NEAR(colour.eval(1.5f, {0.4f, 0.2f}).x, 3, 1e-3);
}

TEST(Colour, RefusesBadInput) {
  const std::vector<glm::vec3> two(2, glm::vec3(1));
  EXPECT_THROW(Colour({}, 2, {}), Error);
  EXPECT_THROW(Colour({0.1f}, 3, two), Error);
  EXPECT_THROW(Colour({0.1f, 0.1f}, 2, {4, glm::vec3(1)}), Error);
  EXPECT_THROW(Colour({2.0f}, 2, two), Error);
  EXPECT_THROW(Colour({0.1f}, 2, {{1, 1, 1}, {-1, 1, 1}}), Error);
  EXPECT_THROW(Colour({0.1f}, 2, {{1, 1, 1}}), Error);
  EXPECT_THROW(Colour({0.1f}, 2, {{1, 1.001e6f, 1}, {1, 1, 1}}), Error);
  EXPECT_NO_THROW(Colour({0.1f}, 2, {{1, 1e6f, 1}, {1, 1, 1}}));
}

}  // namespace
}  // namespace gonio
