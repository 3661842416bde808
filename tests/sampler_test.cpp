#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/brdf/proof/measure.h>
#include <gonio/brdf/bsdf/sampler.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <thread>

#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

// A glossy lobe about the mirror direction over a coloured floor, as a grid.
BrdfTable make_table(const std::function<glm::vec3(double theta_i, double theta_o, double phi)>& f, int n_theta = 45, int n_phi = 45) {
  GridFile file;
  file.n_theta_in = file.n_theta_out = n_theta;
  file.n_phi = n_phi;
  for (int i = 0; i < n_theta; ++i)
    for (int o = 0; o < n_theta; ++o)
      for (int p = 0; p < n_phi; ++p) {
        const glm::vec3 v = f((i + 0.5) * pi<double> / 2 / n_theta, (o + 0.5) * pi<double> / 2 / n_theta, (p + 0.5) * pi<double> / n_phi);
        file.values.insert(file.values.end(), {v.r, v.g, v.b});
      }
  return BrdfTable(GridTable(file), {"made", "made", "mbsdf", "", file.values.size() * 4, {}});
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

const Sampler& glossy_sampler() {
  static const Sampler sampler(glossy_table(), StackOptions{});
  return sampler;
}

TEST(Sampler, MeetsTheQualityItIsBuiltFor) {
  for (const double theta : {2.0, 10.0, 30.0, 50.0, 70.0, 80.0, 85.0}) {
    const auto q = proof::measure(proof::subject_of(glossy_sampler()), theta * degree);
    EXPECT_LT(q.relvar, 0.02) << theta;
    EXPECT_EQ(q.invalid_fraction, 0) << theta;
    EXPECT_NEAR(q.pdf_integral, 1, 1e-3) << theta;
    EXPECT_TRUE(q.chi2.passed(proof::sidak(0.01, 7))) << theta << ": " << q.chi2.summary();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(q.albedo[c] / q.albedo_table[c], 1, 5e-3) << theta;
  }
}

TEST(Sampler, WeightIsFCosineOverPdf) {
  proof::Random random(3);
  for (int k = 0; k < 5000; ++k) {
    const float theta = 1.5f * random(), phi = 6.28f * random();
    const glm::vec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const auto s = glossy_sampler().sample(wi, random.pair());
    ASSERT_TRUE(s);
    ASSERT_NEAR(glossy_sampler().pdf(wi, s->wo) / s->pdf, 1, 2e-3);
    const glm::vec3 expected = glossy_sampler().eval(wi, s->wo) * (s->wo.z / s->pdf);
    for (int c = 0; c < 3; ++c) ASSERT_FLOAT_EQ(s->weight[c], expected[c]);
  }
}

TEST(Sampler, TurnsWithTheSurface) {  // isotropy: both directions rotated about the normal
  const glm::vec3 wi(std::sin(0.7f), 0, std::cos(0.7f));
  const auto turn = [](const glm::vec3& w, float a) {
    return glm::vec3(std::cos(a) * w.x - std::sin(a) * w.y, std::sin(a) * w.x + std::cos(a) * w.y, w.z);
  };
  const auto s = glossy_sampler().sample(wi, {0.3f, 0.8f});
  EXPECT_LT(s->wo.x, 0);  // the mirror direction is opposite wi
  for (const float a : {0.5f, 2.0f, -2.5f, pi<float>}) {
    const auto t = glossy_sampler().sample(turn(wi, a), {0.3f, 0.8f});
    const glm::vec3 expected = turn(s->wo, a);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(t->wo[c], expected[c], 2e-6);
    EXPECT_NEAR(glossy_sampler().pdf(turn(wi, a), expected) / s->pdf, 1, 1e-3);
  }
}

TEST(Sampler, NothingBelowTheHorizon) {
  const glm::vec3 up(0, 0, 1), down(0, 0, -1), level(1, 0, 0);
  EXPECT_FALSE(glossy_sampler().sample(down, {0.5f, 0.5f}));
  EXPECT_FALSE(glossy_sampler().sample(level, {0.5f, 0.5f}));
  EXPECT_EQ(glossy_sampler().pdf(up, down), 0);
  EXPECT_EQ(glossy_sampler().pdf(down, up), 0);
  EXPECT_EQ(glossy_sampler().eval(up, down), glm::vec3(0));
  EXPECT_EQ(glossy_sampler().eval(up, level), glm::vec3(0));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(glossy_sampler().sample({nan, nan, nan}, {0.5f, 0.5f}));
}

TEST(Sampler, FPositiveMeansPdfPositive) {
  proof::Random random(9);
  for (int k = 0; k < 100000; ++k) {
    const float theta = 1.57f * random();
    const glm::vec3 wi(std::sin(theta), 0, std::cos(theta));
    const float z = random(), r = std::sqrt(1 - z * z), phi = 6.2831853f * random();
    const glm::vec3 wo(r * std::cos(phi), r * std::sin(phi), z);
    if (luminance(glossy_sampler().eval(wi, wo)) * wo.z > 0) {
      ASSERT_GT(glossy_sampler().pdf(wi, wo), 0);
    }
  }
}

TEST(Sampler, LambertIsPerfectAndSmall) {
  const auto table = std::make_shared<const BrdfTable>(make_table([](double, double, double) { return glm::vec3(0.5f / pi<float>); }));
  const Sampler sampler(table);
  EXPECT_LT(sampler.bytes(), 4096u);
  const auto q = proof::measure(proof::subject_of(sampler), 40 * degree);
  EXPECT_LT(q.relvar, 2e-3);
  EXPECT_NEAR(q.albedo.r, 0.5, 5e-4);
}

TEST(Sampler, TheDefaultIsAtLeastAsGood) {
  const Sampler sampler(glossy_table());
  EXPECT_EQ(sampler.stack().interpolation(), Interpolation::blend);
  EXPECT_EQ(sampler.stack().storage(), Storage::packed16);
  for (const double theta : {2.0, 50.0, 80.0}) {
    const auto q = proof::measure(proof::subject_of(sampler), theta * degree);
    EXPECT_LT(q.relvar, 0.004) << theta;
    EXPECT_NEAR(q.pdf_integral, 1, 1e-3) << theta;
  }
}

TEST(Sampler, BlackTableGivesBlack) {
  const auto table = std::make_shared<const BrdfTable>(make_table([](double, double, double) { return glm::vec3(0); }));
  const Sampler sampler(table);
  const auto q = proof::measure(proof::subject_of(sampler), 40 * degree);
  EXPECT_EQ(q.albedo.r, 0);
  EXPECT_EQ(q.relvar, 0);
  EXPECT_NEAR(q.pdf_integral, 1, 1e-3);
}

TEST(Sampler, NeedsATable) {
  const std::shared_ptr<const BrdfTable> none;
  EXPECT_THROW(Sampler{none}, Error);
  EXPECT_THROW(Sampler(none, StackOptions{}), Error);
  EXPECT_THROW(Sampler(none, build_stack(*glossy_table())), Error);
  EXPECT_THROW(UniformSampler{none}, Error);
  EXPECT_THROW(CosineSampler{none}, Error);
  EXPECT_THROW(RglSampler{none}, Error);
}

TEST(Sampler, SharedBetweenThreads) {
  const auto sum = [] {
    proof::Random random(11);
    double total = 0;
    for (int k = 0; k < 20000; ++k) {
      const float theta = 1.5f * random();
      const auto s = glossy_sampler().sample({std::sin(theta), 0, std::cos(theta)}, random.pair());
      total += s->pdf + glossy_sampler().pdf({std::sin(theta), 0, std::cos(theta)}, s->wo);
    }
    return total;
  };
  double other = 0;
  std::thread thread([&] { other = sum(); });
  const double here = sum();
  thread.join();
  EXPECT_EQ(here, other);
}

TEST(Build, LimitsHold) {
  StackOptions options;
  options.incident = 9;
  options.meridians = 8;
  options.parallels = 7;
  const StackGrid small = build_stack(*glossy_table(), options);
  EXPECT_LE(small.theta_i.size(), 9u);
  for (const auto& d : small.diagrams) EXPECT_TRUE(d.phi.size() <= 8 && d.r.size() <= 7);
  options = {};
  options.bytes = 30000;
  EXPECT_LE(Stack<float>(build_stack(*glossy_table(), options), Interpolation::displacement).bytes(), 30000u + 1024);
  options.incident = 1;
  EXPECT_THROW(build_stack(*glossy_table(), options), Error);
}

TEST(Build, DoesNotDependOnScheduling) {
  const StackGrid a = build_stack(*glossy_table()), b = build_stack(*glossy_table());
  EXPECT_EQ(a.theta_i, b.theta_i);
  EXPECT_EQ(a.diagrams.back().density, b.diagrams.back().density);
}

// The figures the library promises on real measurements, for every method that has to hold them.
TEST(Sampler, RealMaterials) {
  const char* data = std::getenv("GONIO_TEST_DATA");
  if (!data) GTEST_SKIP() << "GONIO_TEST_DATA is unset: no measured materials";
  for (const char* file : {"rgl/cg_sunflower_rgb.bsdf", "mbsdf/carpaint_red.mbsdf"}) {
    const auto table = std::make_shared<const BrdfTable>(load_table(std::filesystem::path(data) / file));
    const Sampler sampler(table);
    EXPECT_LE(sampler.bytes(), 768u * 1024) << file;  // 256 KiB when packed
    for (const double theta : {2.0, 50.0, 85.0}) {
      const auto q = proof::measure(proof::subject_of(sampler), theta * degree);
      EXPECT_LE(q.relvar, theta > 80 ? 0.05 : 0.02) << file << " at " << theta;
      EXPECT_EQ(q.invalid_fraction, 0) << file << " at " << theta;
      EXPECT_NEAR(q.pdf_integral, 1, 1e-3) << file << " at " << theta;
      EXPECT_TRUE(q.chi2.passed(proof::sidak(0.01, 9))) << file << " at " << theta << ": " << q.chi2.summary();
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(q.albedo[c] / q.albedo_table[c], 1, 5e-3) << file << " at " << theta;
    }
  }
}

/// What chi-square tests draw is what sample() draws.
TEST(Sampler, SubjectsDirectionIsThatOfTheSample) {
  const proof::Subject subject = proof::subject_of(glossy_sampler());
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

}  // namespace
}  // namespace gonio
