// The adapters that docs/guide/integrate.md shows, as the renderers would call them.

#include <memory>
#include <random>
#include <type_traits>

#include <gtest/gtest.h>

#include <gonio/brdf/build/make_bsdf.h>
#include <gonio/fitting/model/synth.h>

#include "docs/examples/mitsuba_bsdf.h"
#include "docs/examples/pbrt_bxdf.h"

namespace gonio {
namespace {

std::shared_ptr<const BrdfTable> table_of(const char* description) {
  return std::make_shared<const BrdfTable>(MbsdfTable(synthesize_mbsdf(parse_model(description), 32, 48)),
                                           BrdfTable::Info{});
}

Bsdf make_material() {
  BsdfOptions options;
  options.interpolation = Interpolation::displacement;
  options.incident = options.meridians = options.parallels = 24;
  return make_bsdf(table_of("ggx:alpha=0.3,F0=0.4/0.3/0.2+lambert:albedo=0.3/0.2/0.1"), options);
}

/// Coloured, and built once.
const Bsdf& material() {
  static const Bsdf bsdf = make_material();
  return bsdf;
}

struct Direction {
  float x, y, z;
};

/// Uniform on the hemisphere above or below.
Direction random_direction(std::mt19937& engine, bool below) {
  std::uniform_real_distribution<float> uniform;
  const float z = uniform(engine), phi = 2 * pi<float> * uniform(engine), r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), below ? -z : z};
}

// pbrt gives the memory of a BxDF back without its destructor, and makes one at every hit.
TEST(Integrate, PbrtBxDFIsAPointer) {
  static_assert(std::is_trivially_copyable_v<GonioBxDF> && std::is_trivially_destructible_v<GonioBxDF>);
  static_assert(sizeof(GonioBxDF) == sizeof(void*));
  auto table = table_of("lambert:albedo=0.5");
  const std::weak_ptr<const BrdfTable> alive = table;
  BsdfOptions coarse;
  coarse.incident = coarse.meridians = coarse.parallels = 4;
  {
    const GonioMaterial owner(make_bsdf(std::move(table), coarse));
    pbrt::ScratchBuffer buffer;
    for (int hit = 0; hit < 3; ++hit) {
      EXPECT_TRUE(pbrt::GetBSDF(owner, buffer).Sample_f({0, 0, 1}, 0, {0.5f, 0.5f}, pbrt::TransportMode::Radiance));
    }
    EXPECT_EQ(alive.use_count(), 1) << "hits own nothing";
  }
  EXPECT_TRUE(alive.expired());
}

TEST(Integrate, PbrtDrawsAndValuesAgree) {
  const GonioMaterial owner(material());
  pbrt::ScratchBuffer buffer;
  const GonioBxDF& bxdf = pbrt::GetBSDF(owner, buffer);
  const auto mode = pbrt::TransportMode::Radiance;
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> uniform;
  int drawn = 0;
  for (int k = 0; k < 2000; ++k) {
    const Direction d = random_direction(engine, k % 2 == 1);
    const pbrt::Vector3f wo{d.x, d.y, d.z};
    const auto s = bxdf.Sample_f(wo, 0, {uniform(engine), uniform(engine)}, mode);
    if (!s) continue;
    ++drawn;
    EXPECT_GT(s->wi.z * wo.z, 0) << "reflection stays on the side of wo";
    const pbrt::SampledSpectrum f = bxdf.f(wo, s->wi, mode);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(s->f[c] / f[c], 1, 1e-2) << d.z;
    EXPECT_NEAR(bxdf.PDF(wo, s->wi, mode) / s->pdf, 1, 1e-2);
    // The same material from below, and nothing through it.
    const pbrt::SampledSpectrum mirrored = bxdf.f(-wo, -s->wi, mode);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(mirrored[c], f[c]);
    EXPECT_EQ(bxdf.PDF(-wo, -s->wi, mode), bxdf.PDF(wo, s->wi, mode));
    EXPECT_EQ(bxdf.f(wo, -s->wi, mode)[0], 0);
    EXPECT_EQ(bxdf.PDF(wo, -s->wi, mode), 0);
  }
  EXPECT_GT(drawn, 1900);
  const auto transmission = pbrt::BxDFReflTransFlags::Transmission;
  EXPECT_FALSE(bxdf.Sample_f({0, 0, 1}, 0, {0.5f, 0.5f}, mode, transmission));
  EXPECT_EQ(bxdf.PDF({0, 0, 1}, {0, 0, 1}, mode, transmission), 0);
  EXPECT_FALSE(bxdf.Sample_f({1, 0, 0}, 0, {0.5f, 0.5f}, mode)) << "on the horizon";
}

TEST(Integrate, MitsubaDrawsAndValuesAgree) {
  const GonioBSDF one_sided(material(), false), two_sided(material(), true);
  EXPECT_EQ(one_sided.flags() & mitsuba::BackSide, 0u);
  EXPECT_NE(two_sided.flags() & mitsuba::BackSide, 0u);
  std::mt19937 engine(6);
  std::uniform_real_distribution<float> uniform;
  for (int k = 0; k < 2000; ++k) {
    const bool below = k % 2 == 1;
    const Direction d = random_direction(engine, below);
    const mitsuba::SurfaceInteraction si{{d.x, d.y, d.z}};
    const mitsuba::Point2f u{uniform(engine), uniform(engine)};
    const auto [s, weight] = two_sided.sample(si, 0, u);
    if (s.pdf == 0) continue;
    EXPECT_GT(s.wo.z * si.wi.z, 0);
    const mitsuba::Spectrum value = two_sided.eval(si, s.wo);
    const float pdf = two_sided.pdf(si, s.wo);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(weight[c] * pdf / value[c], 1, 1e-2);
    EXPECT_NEAR(pdf / s.pdf, 1, 1e-2);
    const mitsuba::Vector3f through{s.wo.x, s.wo.y, -s.wo.z};
    EXPECT_EQ(two_sided.eval(si, through)[1], 0);
    EXPECT_EQ(two_sided.pdf(si, through), 0);
    // From behind, the one-sided material is black and draws nothing.
    EXPECT_EQ(one_sided.sample(si, 0, u).first.pdf, below ? 0 : s.pdf);
    EXPECT_EQ(one_sided.eval(si, s.wo)[0], below ? 0 : value[0]);
    EXPECT_EQ(one_sided.pdf(si, s.wo), below ? 0 : pdf);
    if (below) {
      EXPECT_EQ(one_sided.eval_diffuse_reflectance(si)[0], 0);
    }
  }
}

TEST(Integrate, AlbedoIsTheMeanWeight) {
  const GonioMaterial owner(material());
  pbrt::ScratchBuffer buffer;
  const GonioBxDF& pbrt_side = pbrt::GetBSDF(owner, buffer);
  const GonioBSDF mitsuba_side(material(), true);
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> uniform;
  for (const float theta : {0.1f, 0.75f, 1.3f}) {
    for (const float side : {1.0f, -1.0f}) {
      const pbrt::Vector3f wo{std::sin(theta), 0, side * std::cos(theta)};
      const mitsuba::SurfaceInteraction si{{wo.x, wo.y, wo.z}};
      double f_sum = 0, weight_sum = 0;
      constexpr int n = 20000;
      for (int k = 0; k < n; ++k) {
        const float u = uniform(engine), v = uniform(engine);
        if (const auto s = pbrt_side.Sample_f(wo, 0, {u, v}, pbrt::TransportMode::Radiance))
          f_sum += s->f[0] * pbrt::AbsCosTheta(s->wi) / s->pdf;
        weight_sum += mitsuba_side.sample(si, 0, {u, v}).second[0];
      }
      EXPECT_NEAR(f_sum / n / pbrt_side.rho(wo)[0], 1, 0.01) << theta;
      EXPECT_NEAR(weight_sum / n / mitsuba_side.eval_diffuse_reflectance(si)[0], 1, 0.01) << theta;
    }
  }
}

}  // namespace
}  // namespace gonio
