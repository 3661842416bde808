// The limit that people know: a draw from an analytic GGX, with direction, pdf and RGB weight as those of Bsdf.

#include <algorithm>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>
#include <glm/glm.hpp>

#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/brdf/value/bsdf_sample.h>
#include <gonio/mapping/numeric/fast_math.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio::bench {
namespace {

constexpr std::size_t queries = 1 << 12;

/// Isotropic GGX with Schlick's Fresnel term and height-correlated masking (Heitz 2014).
struct Ggx {
  float alpha;
  glm::vec3 f0;

  /// Visible normals by spherical caps: Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (2023).
  BsdfSample sample(const glm::vec3& wi, const glm::vec2& u) const noexcept {
    const glm::vec3 stretched = glm::normalize(glm::vec3(alpha * wi.x, alpha * wi.y, wi.z));
    const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
    const float sine = std::sqrt(std::max(1 - z * z, 0.0f));
    const auto turn = sin_cos(2 * pi<float> * u.x);
    const glm::vec3 cap = glm::vec3(sine * turn.cos, sine * turn.sin, z) + stretched;
    const glm::vec3 h = glm::normalize(glm::vec3(alpha * cap.x, alpha * cap.y, cap.z));
    const float cos_h = glm::dot(wi, h);
    const glm::vec3 wo = 2 * cos_h * h - wi;

    const float a2 = alpha * alpha;
    const float root_i = std::sqrt(a2 + (1 - a2) * wi.z * wi.z), root_o = std::sqrt(a2 + (1 - a2) * wo.z * wo.z);
    const float d = h.z * h.z * (a2 - 1) + 1;
    const float pdf = a2 / (2 * pi<float> * d * d * (wi.z + root_i));
    const float g2_over_g1 = wo.z * (wi.z + root_i) / (wi.z * root_o + wo.z * root_i);
    const float x = 1 - cos_h, x2 = x * x;
    return {wo, pdf, wo.z > 0 ? (f0 + (1.0f - f0) * (x2 * x2 * x)) * g2_over_g1 : glm::vec3(0)};
  }
};

void ggx_sample(benchmark::State& state) {
  const Ggx ggx{0.2f, {0.9f, 0.6f, 0.3f}};
  proof::Random random(1);
  std::vector<glm::vec3> wi;
  std::vector<glm::vec2> u;
  for (std::size_t k = 0; k < queries; ++k) {
    const float cos_theta = std::sqrt(random()), sin_theta = std::sqrt(1 - cos_theta * cos_theta);
    const float phi = 2 * pi<float> * random();
    wi.push_back({sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
    u.push_back(random.pair());
  }
  for (auto _ : state)
    for (std::size_t k = 0; k < queries; ++k) benchmark::DoNotOptimize(ggx.sample(wi[k], u[k]));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * queries));
}
BENCHMARK(ggx_sample);

}  // namespace
}  // namespace gonio::bench
