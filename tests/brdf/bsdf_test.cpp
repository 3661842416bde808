#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <gonio/brdf/build/compact/colour_of_table.h>
#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/build/make_bsdf.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/gtest.h>
#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/brdf/table/albedo.h>
#include <gonio/brdf/value/luminance.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/batch_subject.h"
#include "tests/support/batch_targets.h"
#include "tests/support/files.h"

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

class BsdfOn : public OnTarget {};
GONIO_ON_ALL_TARGETS(BsdfOn);

// ---------------------------------------------------------------- against plain scalar code, on every instruction set

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
  void sample(const Bsdf& bsdf, std::size_t count) {
    bsdf.sample_n(count, wi.arrays(), u.data(), v.data(), wo.arrays(), pdf.data(), weight.arrays());
  }
};

std::shared_ptr<const BrdfTable> gallery_table(const std::string& name) {
  for (const auto& entry : proof::gallery_tables())
    if (entry.name == name) return std::make_shared<const BrdfTable>(to_table(entry));
  throw std::logic_error("the Gallery has no table " + name);
}

struct Case {
  StackBsdf plain;
  Bsdf bsdf;
  std::string name;
};

Case make(const std::shared_ptr<const BrdfTable>& from, Interpolation interpolation, Chart chart, bool self_contained) {
  BsdfOptions options;
  options.incident = 12;
  options.meridians = options.parallels = 16;
  options.chart = chart;
  options.interpolation = interpolation;
  BsdfData data{build_stack(*from, options), interpolation, {}};
  const std::string name = to_string(interpolation);
  if (!self_contained) return {StackBsdf(data, from), Bsdf(data, from), name + ", table"};
  const Stack<float> stack = sampled_stack(data);
  data.colour = colour_of_table(*from, direction_map(stack), {0, 0.3f, 0.9f, 1.5f}, 8);
  return {StackBsdf(data), Bsdf(data), name + ", self-contained"};
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> list;
    const auto from = gallery_table("asymmetric");
    for (const auto& [interpolation, chart] :
         {std::pair{Interpolation::displacement, Chart::outgoing}, {Interpolation::blend, Chart::half}})
      for (const bool self_contained : {false, true}) list.push_back(make(from, interpolation, chart, self_contained));
    return list;
  }();
  return all;
}

/// How far the direction moves when u or v does by a few float steps.
float spread(const StackBsdf& bsdf, const glm::vec3& wi, const glm::vec2& uv) {
  const auto centre = bsdf.sample(wi, uv);
  float far = 0;
  for (const glm::vec2 step : {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
    if (const auto s = bsdf.sample(wi, glm::clamp(uv + step * 0x1p-21f, 0.0f, 1.0f)); s && centre)
      far = std::max(far, glm::length(s->wo - centre->wo));
  return far;
}

TEST_P(BsdfOn, OneElementIsThatOfABatch) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Draws d(5003, 1);
    d.sample(c.bsdf, d.u.size());
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    Vectors f_r(d.u.size());
    std::vector<float> pdf(d.u.size());
    c.bsdf.eval_n(d.u.size(), d.wi.arrays(), d.wo.arrays(), f_r.arrays());
    c.bsdf.pdf_n(d.u.size(), d.wi.arrays(), d.wo.arrays(), pdf.data());
    for (std::size_t k = 0; k < d.u.size(); ++k) {
      const auto s = c.bsdf.sample(d.wi[k], {d.u[k], d.v[k]});
      ASSERT_EQ(d.pdf[k] > 0, s.has_value()) << k;
      const double pdf_bound = 2e-3 * pdf[k] + 1e-4 * largest;
      ASSERT_NEAR(c.bsdf.pdf(d.wi[k], d.wo[k]), pdf[k], pdf_bound) << k;
      const glm::vec3 value = c.bsdf.eval(d.wi[k], d.wo[k]);
      for (int i = 0; i < 3; ++i) {
        const float bound =
            c.bsdf.self_contained() ? 4e-3f * f_r[k][i] + 1e-4f * largest / std::abs(d.wo[k].z) : 1e-5f * f_r[k][i];
        ASSERT_NEAR(value[i], f_r[k][i], bound) << k;
      }
      if (!s) continue;
      ASSERT_LT(glm::length(d.wo[k] - s->wo), 1e-4f + spread(c.plain, d.wi[k], {d.u[k], d.v[k]})) << k;
      ASSERT_NEAR(d.pdf[k], s->pdf, 2e-3 * s->pdf + 5e-4 * largest) << k;  // as below
      const glm::vec3 weight =
          c.bsdf.self_contained() ? d.weight[k] : c.plain.eval(d.wi[k], s->wo) * (s->wo.z / s->pdf);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(s->weight[i], weight[i], 1e-4 * weight[i]) << k;
    }
  }
}

TEST_P(BsdfOn, SamplesAsStackBsdfDoes) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Draws d(5003, 1);
    d.sample(c.bsdf, d.u.size());
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    for (std::size_t k = 0; k < d.u.size(); ++k) {
      const auto s = c.plain.sample(d.wi[k], {d.u[k], d.v[k]});
      ASSERT_EQ(d.pdf[k] > 0, s.has_value()) << k;
      if (!s) {
        ASSERT_EQ(d.wo[k], glm::vec3(0));
        ASSERT_EQ(d.weight[k], glm::vec3(0));
        continue;
      }
      ASSERT_LT(glm::length(d.wo[k] - s->wo), 1e-4f + spread(c.plain, d.wi[k], {d.u[k], d.v[k]})) << k;
      // Of two directions, a little apart: next to the horizon the density falls to 0 within few floats of v.
      ASSERT_NEAR(d.pdf[k], s->pdf, 2e-3 * s->pdf + 5e-4 * largest) << k;
      const glm::vec3 weight =
          c.bsdf.self_contained() ? s->weight : c.plain.eval(d.wi[k], d.wo[k]) * (d.wo[k].z / d.pdf[k]);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(d.weight[k][i], weight[i], 1e-5 * weight[i] + 1e-6) << k;
    }
  }
}

TEST_P(BsdfOn, EvaluatesAsStackBsdfDoes) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Draws d(5003, 2);
    d.sample(c.bsdf, d.u.size());
    const std::size_t count = d.u.size();
    const float largest = *std::max_element(d.pdf.begin(), d.pdf.end());
    for (std::size_t k = 0; k < count; k += 9) d.wo.set(k, d.wo[k] * glm::vec3(1, 1, -1));
    Vectors f_r(count, -7);
    std::vector<float> pdf(count, -7);
    c.bsdf.eval_n(count, d.wi.arrays(), d.wo.arrays(), f_r.arrays());
    c.bsdf.pdf_n(count, d.wi.arrays(), d.wo.arrays(), pdf.data());
    for (std::size_t k = 0; k < count; ++k) {
      const glm::vec3 expected = c.plain.eval(d.wi[k], d.wo[k]);
      const float p = c.plain.pdf(d.wi[k], d.wo[k]);
      ASSERT_NEAR(pdf[k], p, 2e-3 * p + 1e-4 * largest) << k;
      for (int i = 0; i < 3; ++i) {
        const float bound =
            c.bsdf.self_contained() ? 4e-3f * expected[i] + 1e-4f * largest / std::abs(d.wo[k].z) : 1e-5f * expected[i];
        ASSERT_NEAR(f_r[k][i], expected[i], bound) << k;
      }
    }
  }
}

TEST_P(BsdfOn, InvariantsHold) {
  proof::InvariantOptions options;
  options.draws = 30000;
  options.points = 500;
  options.runs = 60;
  for (const Case& c : cases()) {
    for (const double theta_i : {0.0, 0.8, 1.3}) {
      // f_r of a self-contained BSDF is W pdf / cos theta_o: as exact as that pdf, whose bound is for 1 % of the peak
      // here.
      options.weight_bound = c.bsdf.self_contained() ? 1e-2 : 1e-4;
      options.density_floor = c.bsdf.self_contained() ? 1e-2 : 1e-6;
      options.direction_bound = c.bsdf.chart() == Chart::half ? 1e-3 : 5e-4;
      EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(batch_subject(c.bsdf), theta_i, options) << c.name;
      EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(proof::subject_of(c.bsdf), theta_i, options) << c.name << ", one at a time";
    }
  }
}

// The harness sees what is wrong in a batch: a weight off by 1 %.
TEST_P(BsdfOn, WrongWeightsAreFound) {
  proof::Subject subject = batch_subject(cases().front().bsdf);
  subject.sample = [right = subject.sample](const glm::vec3& wi, const glm::vec2& u) {
    auto s = right(wi, u);
    if (s) s->weight *= 1.01f;
    return s;
  };
  proof::InvariantOptions options;
  options.draws = 1000;
  EXPECT_NE(proof::failures(check_invariants(subject, 0.8, options)).find("weight:"), std::string::npos);
}

TEST_P(BsdfOn, EveryLength) {
  for (const Case& c : cases()) {
    Draws all(70, 3);
    all.sample(c.bsdf, 70);
    for (std::size_t count = 0; count < 70; ++count) {
      Draws d(70, 3);
      d.sample(c.bsdf, count);
      for (std::size_t k = 0; k < 70; ++k) {
        ASSERT_EQ(d.wo[k], k < count ? all.wo[k] : glm::vec3(-7)) << count;
        ASSERT_EQ(d.pdf[k], k < count ? all.pdf[k] : -7) << count;
        ASSERT_EQ(d.weight[k], k < count ? all.weight[k] : glm::vec3(-7)) << count;
      }
    }
  }
}

TEST_P(BsdfOn, NothingBelowTheHorizon) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const glm::vec3 up(0.6f, 0, 0.8f), normal(0, 0, 1), down(0.6f, 0, -0.8f), level(1, 0, 0), none(nan, nan, nan);
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    for (const proof::Subject& s : {proof::subject_of(c.bsdf), batch_subject(c.bsdf), proof::subject_of(c.plain)}) {
      for (const glm::vec3& wi : {down, level, none}) EXPECT_FALSE(s.sample(wi, {0.5f, 0.5f}));
      for (const glm::vec2& u : {glm::vec2(nan, 0.5f), glm::vec2(0.5f, nan)}) EXPECT_FALSE(s.sample(up, u));
      for (const glm::vec3& above : {up, normal})
        for (const glm::vec3& below : {down, level, none, -normal}) {
          EXPECT_EQ(s.pdf(above, below), 0);
          EXPECT_EQ(s.pdf(below, above), 0);
          EXPECT_EQ(s.f_r(above, below), glm::vec3(0));
          EXPECT_EQ(s.f_r(below, above), glm::vec3(0));
        }
      EXPECT_EQ(s.pdf(down, down), 0);
      EXPECT_EQ(s.f_r(down, down), glm::vec3(0));
    }
  }
}

// f_r of a self-contained BSDF stays what it is next to the horizon, where W pdf / cos theta_o would grow without
// bound.
TEST_P(BsdfOn, SelfContainedValuesAtTheHorizon) {
  static const BsdfData data = fit_compact(*gallery_table("specular")).best().data;
  const Bsdf bsdf(data);
  const StackBsdf plain(data);
  const glm::vec3 wi(std::sin(0.7f), 0, std::cos(0.7f));
  const float above = plain.eval(wi, {-1, 0, 1e-3f}).y;
  for (const float z : {1e-4f, 1e-7f, 1e-30f, std::numeric_limits<float>::denorm_min()}) {
    const glm::vec3 wo(-1, 0, z);
    EXPECT_LE(plain.eval(wi, wo).y, 1.01f * above) << z;
    EXPECT_LE(bsdf.eval(wi, wo).y, 1.01f * above) << z;
    EXPECT_LE(batch_subject(bsdf).f_r(wi, wo).y, 1.01f * above) << z;
  }
}

// Colour of one row and of one angle: what has no neighbour to be mixed with.
TEST_P(BsdfOn, SmallestColour) {
  StackGrid grid = proof::gallery_stacks().front().grid;
  grid.theta_i.resize(1), grid.diagrams.resize(1);
  const BsdfData data{grid, Interpolation::displacement, Colour({0.0f}, 2, {{1, 2, 3}, {4, 5, 6}})};
  const StackBsdf plain(data);
  const Bsdf bsdf(data);
  Draws d(100, 4);
  d.sample(bsdf, 100);
  for (std::size_t k = 0; k < 100; ++k) {
    const auto s = plain.sample(d.wi[k], {d.u[k], d.v[k]});
    for (int i = 0; s && i < 3; ++i) ASSERT_NEAR(d.weight[k][i], s->weight[i], 1e-5);
  }
}

TEST(Bsdf, SaysWhatItHolds) {
  for (const Case& c : cases()) {
    const bool blend = c.name.find("blend") != std::string::npos;
    EXPECT_EQ(c.bsdf.self_contained(), c.name.find("self-contained") != std::string::npos);
    EXPECT_EQ(c.bsdf.interpolation(), blend ? Interpolation::blend : Interpolation::displacement);
    EXPECT_EQ(c.bsdf.chart(), blend ? Chart::half : Chart::outgoing);
    EXPECT_EQ(c.bsdf.incident_angles(), c.plain.stack().theta_i().size());
    std::size_t crossings = 0;
    for (const Diagram<float>& d : c.plain.stack().diagrams()) crossings += d.meridians() * d.parallels();
    EXPECT_GT(c.bsdf.bytes(), 2 * crossings);
    // Beside the 16 bits, masses, and what one object has, lines are filled up to those of the largest diagram.
    EXPECT_LT(c.bsdf.bytes(), (blend ? 4 : 8) * crossings + 4096 + (c.bsdf.self_contained() ? 8 * 4 * 32 : 0))
        << c.name;
  }
}

TEST(Bsdf, RefusesWhatItCannotHold) {
  const auto table = gallery_table("asymmetric");
  const StackGrid grid = proof::gallery_stacks().front().grid;
  const Colour colour({0.0f}, 2, {{1, 2, 3}, {4, 5, 6}});
  EXPECT_THROW(Bsdf({grid, Interpolation::mixture, colour}), Error);
  EXPECT_THROW(Bsdf({grid, Interpolation::mixture, {}}, table), Error);
  const BsdfData bare{grid, Interpolation::displacement, {}};
  EXPECT_THROW(Bsdf{bare}, Error);
  EXPECT_THROW(StackBsdf{bare}, Error);
  EXPECT_NO_THROW(Bsdf(bare, table));
  EXPECT_NO_THROW(StackBsdf(bare, table));
  EXPECT_NO_THROW(StackBsdf({grid, Interpolation::mixture, {}}, table));
}

/// What chi-square tests draw is what sample() draws.
TEST(StackBsdf, SubjectsDirectionIsThatOfTheSample) {
  const proof::Subject subject = proof::subject_of(cases().front().plain);
  proof::Random random(3);
  for (int k = 0; k < 1000; ++k) {
    const float theta = 1.6f * random(), phi = 6 * random();  // some below the horizon
    const glm::vec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const glm::vec2 u = random.pair();
    const auto s = subject.sample(wi, u);
    const auto wo = subject.direction(wi, u);
    ASSERT_EQ(s.has_value(), wo.has_value());
    if (s) {
      EXPECT_EQ(s->wo, *wo);
    }
  }
}

// ---------------------------------------------------------------- as make_bsdf() makes it

// A glossy lobe about the mirror direction over a coloured floor, as a grid.
BrdfTable make_table(const std::function<glm::vec3(double theta_i, double theta_o, double phi)>& f, int n_theta = 45,
                     int n_phi = 45) {
  MbsdfFile file;
  file.n_theta_in = file.n_theta_out = n_theta;
  file.n_phi = n_phi;
  for (int i = 0; i < n_theta; ++i)
    for (int o = 0; o < n_theta; ++o)
      for (int p = 0; p < n_phi; ++p) {
        const glm::vec3 v = f((i + 0.5) * pi<double> / 2 / n_theta, (o + 0.5) * pi<double> / 2 / n_theta,
                              (p + 0.5) * pi<double> / n_phi);
        file.values.insert(file.values.end(), {v.r, v.g, v.b});
      }
  return BrdfTable(MbsdfTable(file), {"made", "made", "mbsdf", "", file.values.size() * 4, {}});
}

std::shared_ptr<const BrdfTable> constant_table(float value) {
  return std::make_shared<const BrdfTable>(make_table([value](double, double, double) { return glm::vec3(value); }));
}

glm::vec3 glossy(double theta_i, double theta_o, double phi) {
  const double dx = std::sin(theta_o) * std::cos(phi) + std::sin(theta_i), dy = std::sin(theta_o) * std::sin(phi);
  const float lobe = static_cast<float>(2 * std::exp(-(dx * dx + dy * dy) / 0.04));
  return glm::vec3(lobe) + glm::vec3(0.2f, 0.1f, 0.02f);
}

std::shared_ptr<const BrdfTable> glossy_table() {
  static const auto table = std::make_shared<const BrdfTable>(make_table(glossy));
  return table;
}

/// Diagrams with lines of their own.
BsdfOptions displacement() {
  BsdfOptions options;
  options.interpolation = Interpolation::displacement;
  options.meridians = options.parallels = 40;
  options.budget = 480 * 1024;
  return options;
}

const Bsdf& glossy_bsdf() {
  static const Bsdf bsdf = make_bsdf(glossy_table(), displacement());
  return bsdf;
}

TEST(Bsdf, MeetsTheQualityItIsBuiltFor) {
  for (const double theta : {2.0, 10.0, 30.0, 50.0, 70.0, 80.0, 85.0}) {
    const auto q = proof::measure(proof::subject_of(glossy_bsdf()), theta * degree);
    EXPECT_LT(q.relvar, 0.02) << theta;
    EXPECT_EQ(q.invalid_fraction, 0) << theta;
    EXPECT_NEAR(q.pdf_integral, 1, 1e-3) << theta;
    EXPECT_TRUE(q.chi2.passed(proof::sidak(0.01, 7))) << theta << ": " << q.chi2.summary();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(q.albedo[c] / q.albedo_table[c], 1, 5e-3) << theta;
  }
}

TEST(Bsdf, TheDefaultIsAtLeastAsGood) {
  const Bsdf bsdf = make_bsdf(glossy_table());
  EXPECT_EQ(bsdf.interpolation(), Interpolation::blend);
  EXPECT_FALSE(bsdf.self_contained());
  for (const double theta : {2.0, 50.0, 80.0}) {
    const auto q = proof::measure(proof::subject_of(bsdf), theta * degree);
    EXPECT_LT(q.relvar, 0.004) << theta;
    EXPECT_NEAR(q.pdf_integral, 1, 1e-3) << theta;
  }
}

TEST(Bsdf, WithColoursOfItsOwn) {
  for (BsdfOptions options : {BsdfOptions{}, displacement()}) {
    options.f_r = BsdfValue::colour;
    const Bsdf bsdf = make_bsdf(glossy_table(), options);
    EXPECT_TRUE(bsdf.self_contained());
    EXPECT_EQ(bsdf.interpolation(), options.interpolation);
    for (const float theta : {0.1f, 0.8f, 1.3f}) {
      const glm::vec3 expected = directional_albedo(*glossy_table(), theta), found = bsdf.albedo(theta);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1, 0.01) << theta;
    }
  }
}

// Everything that the optimiser emits is a sampler without fault, 16-bit storage included.
TEST(Bsdf, InvariantsHoldOnWhatIsFitted) {
  BsdfOptions fine;
  fine.f_r = BsdfValue::colour;
  fine.max_variance = 0.01;
  const Bsdf bsdf = make_bsdf(gallery_table("asymmetric"), fine);
  proof::InvariantOptions options;
  options.runs = 10;
  options.direction_bound = 1e-3;
  // f_r is W pdf / cos theta_o: towards the horizon as exact as the pdf is there.
  options.density_floor = 1e-2;
  options.weight_bound = 2e-3;
  for (const double theta_i : {0.0, 0.3, 0.9, 1.3})
    EXPECT_THAT_SAMPLER_INVARIANTS_HOLD(proof::subject_of(bsdf), theta_i, options);
}

TEST(Bsdf, WeightIsFCosineOverPdf) {
  proof::Random random(3);
  for (int k = 0; k < 5000; ++k) {
    const float theta = 1.5f * random(), phi = 6.28f * random();
    const glm::vec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const auto s = glossy_bsdf().sample(wi, random.pair());
    ASSERT_TRUE(s);
    ASSERT_NEAR(glossy_bsdf().pdf(wi, s->wo) / s->pdf, 1, 2e-3);
    const glm::vec3 expected = glossy_bsdf().eval(wi, s->wo) * (s->wo.z / s->pdf);
    for (int c = 0; c < 3; ++c) ASSERT_FLOAT_EQ(s->weight[c], expected[c]);
  }
}

TEST(Bsdf, TurnsWithTheSurface) {  // isotropy: both directions rotated about the normal
  const glm::vec3 wi(std::sin(0.7f), 0, std::cos(0.7f));
  const auto turn = [](const glm::vec3& w, float a) {
    return glm::vec3(std::cos(a) * w.x - std::sin(a) * w.y, std::sin(a) * w.x + std::cos(a) * w.y, w.z);
  };
  const auto s = glossy_bsdf().sample(wi, {0.3f, 0.8f});
  EXPECT_LT(s->wo.x, 0);  // the mirror direction is opposite wi
  for (const float a : {0.5f, 2.0f, -2.5f, pi<float>}) {
    const auto t = glossy_bsdf().sample(turn(wi, a), {0.3f, 0.8f});
    const glm::vec3 expected = turn(s->wo, a);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(t->wo[c], expected[c], 2e-6);
    EXPECT_NEAR(glossy_bsdf().pdf(turn(wi, a), expected) / s->pdf, 1, 1e-3);
  }
}

TEST(Bsdf, FPositiveMeansPdfPositive) {
  proof::Random random(9);
  for (int k = 0; k < 100000; ++k) {
    const float theta = 1.57f * random();
    const glm::vec3 wi(std::sin(theta), 0, std::cos(theta));
    const float z = random(), r = std::sqrt(1 - z * z), phi = 6.2831853f * random();
    const glm::vec3 wo(r * std::cos(phi), r * std::sin(phi), z);
    if (luminance(glossy_bsdf().eval(wi, wo)) * wo.z > 0) {
      ASSERT_GT(glossy_bsdf().pdf(wi, wo), 0);
    }
  }
}

TEST(Bsdf, LambertIsPerfectAndSmall) {
  const auto table = constant_table(0.5f / pi<float>);
  const Bsdf bsdf = make_bsdf(table);
  EXPECT_LT(bsdf.bytes(), 6144u);  // the guide to incident angles takes 4096 of them
  const auto q = proof::measure(proof::subject_of(bsdf), 40 * degree);
  EXPECT_LT(q.relvar, 2e-3);
  EXPECT_NEAR(q.albedo.r, 0.5, 5e-4);
}

TEST(Bsdf, BlackTableGivesBlack) {
  const auto table = constant_table(0);
  const Bsdf bsdf = make_bsdf(table);
  const auto q = proof::measure(proof::subject_of(bsdf), 40 * degree);
  EXPECT_EQ(q.albedo.r, 0);
  EXPECT_EQ(q.relvar, 0);
  EXPECT_NEAR(q.pdf_integral, 1, 1e-3);
  EXPECT_EQ(bsdf.albedo(0.7f), glm::vec3(0));
}

TEST(Bsdf, NeedsATable) {
  const std::shared_ptr<const BrdfTable> none;
  EXPECT_THROW(make_bsdf(none), Error);
  EXPECT_THROW(make_bsdf(none, displacement()), Error);
  EXPECT_THROW(UniformSampler{none}, Error);
  EXPECT_THROW(CosineSampler{none}, Error);
  EXPECT_THROW(RglSampler{none}, Error);
}

TEST(Bsdf, RefusesBadOptions) {
  const auto refused = [](const std::function<void(BsdfOptions&)>& change) {
    BsdfOptions options;
    options.incident = options.meridians = options.parallels = 4;
    change(options);
    EXPECT_THROW(make_bsdf(glossy_table(), options), Error);
  };
  refused([](BsdfOptions& o) { o.max_variance = 0; });
  refused([](BsdfOptions& o) { o.budget = 100; });
  refused([](BsdfOptions& o) { o.incident = 1; });
  refused([](BsdfOptions& o) { o.meridians = 1; });
  refused([](BsdfOptions& o) { o.interpolation = Interpolation::mixture; });
}

// The figures the library promises on real measurements, for every method that has to hold them.
TEST(Bsdf, RealMaterials) {
  if (test::test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is unset: no measured materials";
  for (const char* file : {"rgl/cg_sunflower_rgb.bsdf", "mbsdf/carpaint_red.mbsdf"}) {
    const auto table = std::make_shared<const BrdfTable>(load_table(test::test_data() / file));
    const CompactFit fit = fit_compact(*table).best();
    EXPECT_LE(fit.bytes, 256u * 1024) << file;
    const Bsdf bsdf(fit.data, table);
    EXPECT_LE(bsdf.bytes(), 1024u * 1024) << file;
    for (const double theta : {2.0, 50.0, 85.0}) {
      const auto q = proof::measure(proof::subject_of(bsdf), theta * degree);
      EXPECT_LE(q.relvar, theta > 80 ? 0.05 : 0.02) << file << " at " << theta;
      EXPECT_EQ(q.invalid_fraction, 0) << file << " at " << theta;
      EXPECT_NEAR(q.pdf_integral, 1, 1e-3) << file << " at " << theta;
      EXPECT_TRUE(q.chi2.passed(proof::sidak(0.01, 9))) << file << " at " << theta << ": " << q.chi2.summary();
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(q.albedo[c] / q.albedo_table[c], 1, 5e-3) << file << " at " << theta;
    }
  }
}

// ---------------------------------------------------------------- albedo and roughness

std::shared_ptr<const BrdfTable> synthetic(const char* description) {
  return std::make_shared<const BrdfTable>(MbsdfTable(synthesize_mbsdf(parse_model(description), 32, 48)),
                                           BrdfTable::Info{});
}

Bsdf bsdf_of(const char* description) {
  BsdfOptions options = displacement();
  options.incident = options.meridians = options.parallels = 24;
  return make_bsdf(synthetic(description), options);
}

TEST(Bsdf, AlbedoOfTheTable) {
  const char* const description = "ggx:alpha=0.3,F0=0.4/0.3/0.2+lambert:albedo=0.3/0.2/0.1";
  const auto table = synthetic(description);
  const Bsdf bsdf = bsdf_of(description);
  for (const float degrees : {0.0f, 13.0f, 40.0f, 65.0f, 80.0f}) {
    const float theta = degrees * pi<float> / 180;
    const glm::vec3 expected = directional_albedo(*table, theta), found = bsdf.albedo(theta);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1, 0.01) << degrees;
  }
  EXPECT_EQ(bsdf.albedo(1.6f), glm::vec3(0.0f));
  EXPECT_EQ(bsdf.albedo(-0.1f), bsdf.albedo(0.0f));
}

TEST(Bsdf, RoughnessOfKnownLobes) {
  EXPECT_NEAR(bsdf_of("lambert:albedo=0.5").roughness(), std::tan(pi<float> / 8), 0.02);
  EXPECT_NEAR(bsdf_of("ggx:alpha=0.4,F0=1").roughness(), 0.32, 0.02);
  EXPECT_NEAR(bsdf_of("ggx:alpha=0.15,F0=1").roughness(), 0.15, 0.02);
}

}  // namespace
}  // namespace gonio
