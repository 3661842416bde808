#include <gonio/brdf/batch/batch_sampler.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/gtest.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/base/error.h>
#include <gonio/tests/batch_subject.h>
#include <gonio/tests/batch_targets.h>

namespace gonio {
namespace {

class BatchSamplerOn : public OnTarget {};
GONIO_ON_ALL_TARGETS(BatchSamplerOn);

struct Vectors {
  std::vector<float> x, y, z;

  explicit Vectors(std::size_t count, float value = 0) : x(count, value), y(count, value), z(count, value) {}
  Arrays3 arrays() { return {x.data(), y.data(), z.data()}; }
  ConstArrays3 arrays() const { return {x.data(), y.data(), z.data()}; }
  glm::vec3 operator[](std::size_t k) const { return {x[k], y[k], z[k]}; }
  void set(std::size_t k, const glm::vec3& v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
};

struct Draws {
  Vectors wi, wo, weight;
  std::vector<float> u, v, pdf;

  Draws(std::size_t count, std::uint32_t seed)
      : wi(count), wo(count, -7), weight(count, -7), u(count), v(count), pdf(count, -7) {
    proof::Random random(seed);
    for (std::size_t k = 0; k < count; ++k) {
      const float theta = k % 50 == 0 ? 0 : k % 50 == 1 ? 1.7f : 1.55f * random(), phi = 2 * pi<float> * random();
      wi.set(k, {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
      u[k] = k % 61 == 2 ? 0 : k % 67 == 3 ? 1 - 0x1p-24f : random();
      v[k] = k % 71 == 4 ? 0.5f : random();
    }
  }
  void sample(const BatchSampler& batch, std::size_t count) {
    batch.sample_n(count, wi.arrays(), u.data(), v.data(), wo.arrays(), pdf.data(), weight.arrays());
  }
};

std::shared_ptr<const BrdfTable> table(const std::string& name) {
  for (const auto& entry : proof::gallery_tables())
    if (entry.name == name) return std::make_shared<const BrdfTable>(to_table(entry));
  throw std::logic_error("the Gallery has no table " + name);
}

struct Case {
  proof::Subject sampler;  // one at a time
  BatchSampler batch;
  bool self_contained;
  Chart chart;
  std::string name;
};

Case make(const std::shared_ptr<const BrdfTable>& from, Interpolation interpolation, Chart chart, bool self_contained) {
  StackOptions options;
  options.incident = 12;
  options.meridians = options.parallels = 16;
  options.chart = chart;
  options.interpolation = interpolation;
  const StackGrid grid = build_stack(*from, options);
  const auto made = [&](auto sampler, const char* how) {
    const auto kept = std::make_shared<const decltype(sampler)>(std::move(sampler));
    proof::Subject subject{[kept](const glm::vec3& wi, const glm::vec2& u) { return kept->sample(wi, u); },
                           [kept](const glm::vec3& wi, const glm::vec3& wo) { return static_cast<double>(kept->pdf(wi, wo)); },
                           [kept](const glm::vec3& wi, const glm::vec3& wo) { return kept->eval(wi, wo); }};
    return Case{std::move(subject), BatchSampler(*kept), self_contained, chart, to_string(interpolation) + std::string(how)};
  };
  if (!self_contained) return made(Sampler(from, grid, interpolation), ", table");
  const Stack<float> stack(grid, interpolation);
  Colour colour = Colour::from_table(*from, [&](float t, float u, float v) { return stack.sample(t, u, v); }, {0, 0.3f, 0.9f, 1.5f}, 8);
  const Storage storage = interpolation == Interpolation::blend ? Storage::packed16 : Storage::float32;
  return made(CompactBsdf(grid, interpolation, storage, std::move(colour)), ", self-contained");
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> list;
    const auto from = table("asymmetric");
    for (const auto& [interpolation, chart] :
         {std::pair{Interpolation::displacement, Chart::outgoing}, {Interpolation::blend, Chart::half}})
      for (const bool self_contained : {false, true}) list.push_back(make(from, interpolation, chart, self_contained));
    return list;
  }();
  return all;
}

/// How far the direction moves when u or v does by a few float steps.
float spread(const proof::Subject& sampler, const glm::vec3& wi, const glm::vec2& uv) {
  const auto centre = sampler.sample(wi, uv);
  float far = 0;
  for (const glm::vec2 step : {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
    if (const auto s = sampler.sample(wi, glm::clamp(uv + step * 0x1p-21f, 0.0f, 1.0f)); s && centre)
      far = std::max(far, glm::length(s->wo - centre->wo));
  return far;
}

/// What it answers for one element.
proof::Subject one_at_a_time(const BatchSampler& batch) {
  return {[&](const glm::vec3& wi, const glm::vec2& u) { return batch.sample(wi, u); },
          [&](const glm::vec3& wi, const glm::vec3& wo) { return static_cast<double>(batch.pdf(wi, wo)); },
          [&](const glm::vec3& wi, const glm::vec3& wo) { return batch.eval(wi, wo); }};
}

TEST_P(BatchSamplerOn, OneElementIsThatOfABatch) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const BatchSampler& batch = c.batch;
    Draws d(5003, 1);
    d.sample(batch, d.u.size());
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    Vectors f_r(d.u.size());
    std::vector<float> pdf(d.u.size());
    batch.eval_n(d.u.size(), d.wi.arrays(), d.wo.arrays(), f_r.arrays());
    batch.pdf_n(d.u.size(), d.wi.arrays(), d.wo.arrays(), pdf.data());
    for (std::size_t k = 0; k < d.u.size(); ++k) {
      const auto s = batch.sample(d.wi[k], {d.u[k], d.v[k]});
      ASSERT_EQ(d.pdf[k] > 0, s.has_value()) << k;
      const double pdf_bound = 2e-3 * pdf[k] + 1e-4 * largest;
      ASSERT_NEAR(batch.pdf(d.wi[k], d.wo[k]), pdf[k], pdf_bound) << k;
      const glm::vec3 value = batch.eval(d.wi[k], d.wo[k]);
      for (int i = 0; i < 3; ++i) {
        const float bound = c.self_contained ? 4e-3f * f_r[k][i] + 1e-4f * largest / std::abs(d.wo[k].z) : 0;
        ASSERT_NEAR(value[i], f_r[k][i], bound) << k;
      }
      if (!s) continue;
      ASSERT_LT(glm::length(d.wo[k] - s->wo), 1e-4f + spread(c.sampler, d.wi[k], {d.u[k], d.v[k]})) << k;
      ASSERT_NEAR(d.pdf[k], s->pdf, 2e-3 * s->pdf + 5e-4 * largest) << k;  // as below
      const glm::vec3 weight = c.self_contained ? d.weight[k] : c.sampler.f_r(d.wi[k], s->wo) * (s->wo.z / s->pdf);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(s->weight[i], weight[i], 1e-4 * weight[i]) << k;
    }
  }
}

TEST_P(BatchSamplerOn, SamplesAsSamplerDoes) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const BatchSampler& batch = c.batch;
    Draws d(5003, 1);
    d.sample(batch, d.u.size());
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    for (std::size_t k = 0; k < d.u.size(); ++k) {
      const auto s = c.sampler.sample(d.wi[k], {d.u[k], d.v[k]});
      ASSERT_EQ(d.pdf[k] > 0, s.has_value()) << k;
      if (!s) {
        ASSERT_EQ(d.wo[k], glm::vec3(0));
        ASSERT_EQ(d.weight[k], glm::vec3(0));
        continue;
      }
      ASSERT_LT(glm::length(d.wo[k] - s->wo), 1e-4f + spread(c.sampler, d.wi[k], {d.u[k], d.v[k]})) << k;
      // Of two directions, a little apart: next to the horizon the density falls to 0 within few floats of v.
      ASSERT_NEAR(d.pdf[k], s->pdf, 2e-3 * s->pdf + 5e-4 * largest) << k;
      const glm::vec3 weight = c.self_contained ? s->weight : c.sampler.f_r(d.wi[k], d.wo[k]) * (d.wo[k].z / d.pdf[k]);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(d.weight[k][i], weight[i], 1e-5 * weight[i] + 1e-6) << k;
    }
  }
}

TEST_P(BatchSamplerOn, EvaluatesAsSamplerDoes) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const BatchSampler& batch = c.batch;
    Draws d(5003, 2);
    d.sample(batch, d.u.size());
    const std::size_t count = d.u.size();
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    for (std::size_t k = 0; k < count; k += 9) d.wo.set(k, d.wo[k] * glm::vec3(1, 1, -1));
    Vectors f_r(count, -7);
    std::vector<float> pdf(count, -7);
    batch.eval_n(count, d.wi.arrays(), d.wo.arrays(), f_r.arrays());
    batch.pdf_n(count, d.wi.arrays(), d.wo.arrays(), pdf.data());
    for (std::size_t k = 0; k < count; ++k) {
      const glm::vec3 expected = c.sampler.f_r(d.wi[k], d.wo[k]);
      const float p = static_cast<float>(c.sampler.pdf(d.wi[k], d.wo[k]));
      ASSERT_NEAR(pdf[k], p, 2e-3 * p + 1e-4 * largest) << k;
      for (int i = 0; i < 3; ++i) {
        const float bound = c.self_contained ? 4e-3f * expected[i] + 1e-4f * largest / std::abs(d.wo[k].z) : 0;
        ASSERT_NEAR(f_r[k][i], expected[i], bound) << k;
      }
    }
  }
}

TEST_P(BatchSamplerOn, InvariantsHold) {
  proof::InvariantOptions options;
  options.draws = 30000;
  options.points = 500;
  options.runs = 60;
  for (const Case& c : cases()) {
    const BatchSampler& batch = c.batch;
    for (const double theta_i : {0.0, 0.8, 1.3}) {
      // f_r of a self-contained sampler is W pdf / cos theta_o: as exact as that pdf, whose bound is for 1 % of the peak here.
      options.weight_bound = c.self_contained ? 1e-2 : 1e-4;
      options.density_floor = c.self_contained ? 1e-2 : 1e-6;
      options.direction_bound = c.chart == Chart::half ? 1e-3 : 5e-4;
      EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(batch_subject(batch), theta_i, options) << c.name;
      EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(one_at_a_time(batch), theta_i, options) << c.name << ", one at a time";
    }
  }
}

// The harness sees what is wrong in a batch: a weight off by 1 %.
TEST_P(BatchSamplerOn, WrongWeightsAreFound) {
  const BatchSampler& batch = cases().front().batch;
  proof::Subject subject = batch_subject(batch);
  subject.sample = [right = subject.sample](const glm::vec3& wi, const glm::vec2& u) {
    auto s = right(wi, u);
    if (s) s->weight *= 1.01f;
    return s;
  };
  proof::InvariantOptions options;
  options.draws = 1000;
  EXPECT_NE(proof::failures(check_invariants(subject, 0.8, options)).find("weight:"), std::string::npos);
}

TEST_P(BatchSamplerOn, EveryLength) {
  for (const Case& c : cases()) {
    const BatchSampler& batch = c.batch;
    Draws all(70, 3);
    all.sample(batch, 70);
    for (std::size_t count = 0; count < 70; ++count) {
      Draws d(70, 3);
      d.sample(batch, count);
      for (std::size_t k = 0; k < 70; ++k) {
        ASSERT_EQ(d.wo[k], k < count ? all.wo[k] : glm::vec3(-7)) << count;
        ASSERT_EQ(d.pdf[k], k < count ? all.pdf[k] : -7) << count;
        ASSERT_EQ(d.weight[k], k < count ? all.weight[k] : glm::vec3(-7)) << count;
      }
    }
  }
}

TEST(BatchSampler, SaysWhatItHolds) {
  EXPECT_FALSE(cases()[0].batch.self_contained());
  EXPECT_TRUE(cases()[1].batch.self_contained());
  EXPECT_GT(cases()[1].batch.bytes(), 4 * 32 * 16 + 1024 * sizeof(int));  // four angles, 8 x 4 cells, four floats; the guide
}

// Colour of one row and of one angle: what has no neighbour to be mixed with.
TEST(BatchSampler, SmallestColour) {
  StackGrid grid = proof::gallery_stacks().front().grid;
  grid.theta_i.resize(1), grid.diagrams.resize(1);
  const CompactBsdf sampler(grid, Interpolation::displacement, Storage::float32, Colour({0.0f}, 2, {{1, 2, 3}, {4, 5, 6}}));
  const BatchSampler batch(sampler);
  Draws d(100, 4);
  d.sample(batch, 100);
  for (std::size_t k = 0; k < 100; ++k) {
    const auto s = sampler.sample(d.wi[k], {d.u[k], d.v[k]});
    for (int i = 0; s && i < 3; ++i) ASSERT_NEAR(d.weight[k][i], s->weight[i], 1e-5);
  }
}

TEST(BatchSampler, RefusesMixture) {
  const StackGrid grid = proof::gallery_stacks().front().grid;
  EXPECT_THROW(BatchSampler(Sampler(table("asymmetric"), grid, Interpolation::mixture)), Error);
}

}  // namespace
}  // namespace gonio
