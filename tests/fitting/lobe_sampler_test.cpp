#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/fitting/fit/fit.h>
#include <gonio/fitting/model/synth.h>
#include <gonio/fitting/sampling/lobe_sampler.h>
#include <gonio/fitting/sampling/proposal.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

glm::vec3 direction(double theta_degrees, double phi_degrees = 0) {
  const double t = theta_degrees * pi<double> / 180, p = phi_degrees * pi<double> / 180;
  return glm::vec3(glm::dvec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)));
}

const LobeModel& paint() {
  static const LobeModel model = parse_model("lambert:albedo=0.3/0.2/0.1+ggx:alpha=0.4,F0=0.05+ggx:alpha=0.12,F0=0.1");
  return model;
}

std::shared_ptr<const BrdfTable> table() {
  static const auto shared =
      std::make_shared<const BrdfTable>(MbsdfTable(synthesize_mbsdf(paint())), BrdfTable::Info{});
  return shared;
}

const LobeSampler& sampler(Adaption adaption) {
  const auto make = [](Adaption a) {
    LobeSamplerOptions options;
    options.adaption = a;
    return LobeSampler(table(), paint(), options);
  };
  static const LobeSampler albedo = make(Adaption::albedo), weights = make(Adaption::weights),
                           shapes = make(Adaption::shapes);
  return adaption == Adaption::albedo ? albedo : adaption == Adaption::weights ? weights : shapes;
}

constexpr Adaption all[] = {Adaption::albedo, Adaption::weights, Adaption::shapes};

// Integral over the hemisphere in cells of equal solid angle.
template <class F>
double integrate(const F& f, int n = 800) {
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const float z = static_cast<float>((i + 0.5) / n), s = std::sqrt(1 - z * z);
    for (int j = 0; j < n; ++j) {
      const float phi = static_cast<float>(2 * pi<double> * (j + 0.5) / n);
      sum += f(glm::vec3(s * std::cos(phi), s * std::sin(phi), z));
    }
  }
  return sum * 2 * pi<double> / n / n;
}

double relvar(const LobeSampler& s, const glm::vec3& wi) {
  const int n = 128;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 0.999f);
  double sum = 0, square = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto draw = s.sample(wi, glm::vec2(float(i) + uniform(random), float(j) + uniform(random)) / float(n));
      const double w = draw ? luminance(draw->weight) : 0;
      sum += w;
      square += w * w;
    }
  }
  return square * n * n / (sum * sum) - 1;
}

TEST(LobeSampler, PdfIntegratesToOne) {
  for (Adaption adaption : all) {
    for (double theta : {0.0, 25.0, 60.0, 88.0}) {
      const glm::vec3 wi = direction(theta, 40);
      const auto pdf = [&](const glm::vec3& wo) { return sampler(adaption).pdf(wi, wo); };
      // Near the horizon a lobe of alpha = 0.1 is narrow in the cosine: finer cells.
      EXPECT_NEAR(integrate(pdf, theta > 80 ? 3000 : 800), 1, 2e-3) << theta;
    }
  }
}

TEST(LobeSampler, DrawsFollowThePdf) {
  const int rows = 8, columns = 12, draws = 400000, n = 800;
  for (Adaption adaption : all) {
    for (double theta : {3.0, 50.0, 80.0}) {
      const glm::vec3 wi = direction(theta, -70);
      const auto cell = [&](const glm::vec3& wo) {
        const int row = std::min(rows - 1, int(float(rows) * wo.z));
        const float turn = std::atan2(wo.y, wo.x) / (2 * pi<float>)+0.5f;
        return row * columns + std::min(columns - 1, int(float(columns) * turn));
      };
      std::vector<double> counts(rows * columns), expected(rows * columns);
      std::mt19937 random(11);
      std::uniform_real_distribution<float> uniform(0, 0.99999994f);
      for (int i = 0; i < draws; ++i) {
        const float u = uniform(random), v = uniform(random);
        const auto draw = sampler(adaption).sample(wi, {u, v});
        ASSERT_TRUE(draw);
        counts[cell(draw->wo)] += 1;
      }
      integrate(
          [&](const glm::vec3& wo) {
            expected[cell(wo)] += sampler(adaption).pdf(wi, wo) * 2 * pi<double> / n / n * draws;
            return 0.0;
          },
          n);
      for (int i = 0; i < rows * columns; ++i) {
        // 1 % for the quadrature's cells at the edges.
        EXPECT_NEAR(counts[i], expected[i], 5 * std::sqrt(expected[i] + 1) + 0.01 * expected[i])
            << theta << " cell " << i;
      }
    }
  }
}

TEST(LobeSampler, SampleAgreesWithPdfAndTable) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0, 0.99999994f);
  for (Adaption adaption : all) {
    const LobeSampler& s = sampler(adaption);
    for (int i = 0; i < 3000; ++i) {
      const glm::vec3 wi = direction(89.9 * uniform(random), 360 * uniform(random));
      const float u = uniform(random), v = uniform(random);
      const auto draw = s.sample(wi, {u, v});
      ASSERT_TRUE(draw);
      EXPECT_NEAR(glm::length(draw->wo), 1, 1e-5);
      EXPECT_GT(draw->wo.z, 0);
      EXPECT_NEAR(s.pdf(wi, draw->wo), draw->pdf, 2e-3 * draw->pdf);
      const glm::vec3 f = table()->eval(wi, draw->wo);
      EXPECT_EQ(s.eval(wi, draw->wo), f);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(draw->weight[c] * draw->pdf, f[c] * draw->wo.z, 1e-5 * f[c] + 1e-12);
      }
    }
  }
}

TEST(LobeSampler, EstimatesTheAlbedoWithoutBias) {
  const glm::vec3 wi = direction(50);
  const double albedo = integrate([&](const glm::vec3& wo) { return luminance(table()->eval(wi, wo)) * wo.z; });
  for (Adaption adaption : all) {
    double sum = 0;
    const int n = 256;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto draw = sampler(adaption).sample(wi, glm::vec2(float(i) + 0.5f, float(j) + 0.5f) / float(n));
        sum += draw ? luminance(draw->weight) : 0;
      }
    }
    EXPECT_NEAR(sum / (n * n), albedo, 2e-3 * albedo);
  }
}

TEST(LobeSampler, PositiveWhereverTheTableIs) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  const LobeSampler& s = sampler(Adaption::shapes);
  for (int i = 0; i < 5000; ++i) {
    const glm::vec3 wi = direction(89.99 * uniform(random)),
                    wo = direction(89.99 * uniform(random), 360 * uniform(random));
    // The cosine's share bounds every weight.
    EXPECT_GE(s.pdf(wi, wo), 0.0099f * wo.z / pi<float>);
  }
}

TEST(LobeSampler, AdaptionReducesTheVariance) {
  for (double theta : {10.0, 50.0, 75.0}) {
    const glm::vec3 wi = direction(theta);
    const double by_albedo = relvar(sampler(Adaption::albedo), wi), by_weights = relvar(sampler(Adaption::weights), wi);
    const double by_shapes = relvar(sampler(Adaption::shapes), wi);
    EXPECT_LE(by_weights, by_albedo * 1.02 + 1e-3) << theta;
    EXPECT_LE(by_shapes, by_weights * 1.02 + 1e-3) << theta;
    EXPECT_LT(by_shapes, 0.02) << theta;
  }
  // Negative control: lobes of another material cost variance.
  LobeSamplerOptions options;
  options.adaption = Adaption::albedo;
  const LobeSampler wrong(table(), parse_model("lambert:albedo=0.01+ggx:alpha=0.02,F0=0.9"), options);
  EXPECT_GT(relvar(wrong, direction(30)), 1);
}

TEST(LobeSampler, NothingBelowTheHorizon) {
  const LobeSampler& s = sampler(Adaption::shapes);
  const glm::vec3 up = direction(30), down(0.6f, 0, -0.8f);
  EXPECT_FALSE(s.sample(down, {0.5f, 0.5f}));
  EXPECT_FALSE(s.sample(glm::vec3(1, 0, 0), {0.5f, 0.5f}));
  EXPECT_EQ(s.pdf(down, up), 0);
  EXPECT_EQ(s.pdf(up, down), 0);
  EXPECT_EQ(s.eval(up, down), glm::vec3(0));
}

TEST(LobeSampler, CornersOfTheUnitSquare) {
  const float last = 1 - 0x1p-24f;
  for (double theta : {0.0, 45.0, 89.99}) {
    for (float u : {0.0f, last}) {
      for (float v : {0.0f, last}) {
        const auto draw = sampler(Adaption::shapes).sample(direction(theta), {u, v});
        if (!draw) continue;  // the rim of the cosine's disk
        EXPECT_TRUE(std::isfinite(draw->pdf) && draw->pdf > 0);
        EXPECT_TRUE(std::isfinite(draw->weight.r));
      }
    }
  }
}

TEST(LobeSampler, DiffuseModelsAreSampledByTheCosine) {
  const LobeSampler s(table(), parse_model("oren_nayar"));
  const glm::vec3 wi = direction(30), wo = direction(50, 80);
  EXPECT_NEAR(s.pdf(wi, wo), wo.z / pi<float>, 1e-6);
}

TEST(LobeSampler, OptionsOutOfRangeAreRefused) {
  const auto refused = [](void (*change)(LobeSamplerOptions&)) {
    LobeSamplerOptions options;
    change(options);
    EXPECT_THROW(LobeSampler(table(), paint(), options), Error);
  };
  refused([](LobeSamplerOptions& o) { o.angles = 1; });
  refused([](LobeSamplerOptions& o) { o.cosine_share = 0; });
  refused([](LobeSamplerOptions& o) { o.cosine_share = 1.5f; });
  EXPECT_THROW(LobeSampler(table(), parse_model("ggx+ggx+ggx+ggx+ggx")), Error);
  EXPECT_THROW(LobeSampler(nullptr, paint()), Error);
}

TEST(ShearedGgx, WithoutShearIsGgxBeforeMirroring) {
  const ShearedGgx<double> sheared{0.3, 0.3, 0};
  const Ggx<double> ggx{0.3};
  const glm::dvec3 wi(std::sin(0.6), 0, std::cos(0.6));
  for (double phi : {0.1, 2.0, 3.0}) {
    const glm::dvec3 wo(std::sin(0.8) * std::cos(phi), std::sin(0.8) * std::sin(phi), std::cos(0.8));
    const double expected = ggx.pdf(Angles<double>(wi, wo));
    EXPECT_NEAR(sheared.unfolded_pdf(wi, glm::normalize(wi + wo)), expected, 1e-12);
  }
}

// Counts against densities for lobes far from symmetric, grazing included.
TEST(ShearedGgx, DrawsFollowThePdf) {
  const int rows = 8, columns = 12, draws = 200000, n = 600;
  for (const ShearedGgx<double>& lobe :
       {ShearedGgx<double>{0.2, 0.5, 0.3}, ShearedGgx<double>{0.6, 0.3, -0.8}, ShearedGgx<double>{1.5, 0.4, 1.2}}) {
    for (double theta : {0.0, 40.0, 85.0}) {
      const glm::dvec3 wi(std::sin(theta * pi<double> / 180), 0, std::cos(theta * pi<double> / 180));
      const auto cell = [&](const glm::dvec3& wo) {
        const int row = std::min(rows - 1, int(rows * wo.z));
        const double turn = std::atan2(wo.y, wo.x) / (2 * pi<double>)+0.5;
        return row * columns + std::min(columns - 1, int(columns * turn));
      };
      std::vector<double> counts(rows * columns), expected(rows * columns);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> uniform(0, 1);
      for (int i = 0; i < draws; ++i) {
        const double u = uniform(random), v = uniform(random);
        counts[cell(lobe.sample(wi, u, v))] += 1;
      }
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const double z = (i + 0.5) / n, s = std::sqrt(1 - z * z), phi = 2 * pi<double> * (j + 0.5) / n;
          const glm::dvec3 wo(s * std::cos(phi), s * std::sin(phi), z);
          expected[cell(wo)] += lobe.pdf(wi, wo) * 2 * pi<double> / n / n * draws;
        }
      }
      double total = 0;
      for (int i = 0; i < rows * columns; ++i) {
        EXPECT_NEAR(counts[i], expected[i], 5 * std::sqrt(expected[i] + 1) + 0.02 * expected[i]) << theta;
        total += expected[i];
      }
      EXPECT_NEAR(total / draws, 1, 5e-3) << theta;
    }
  }
}

TEST(Proposal, RefiningFindsTheMixtureThatMadeTheTarget) {
  const ShearedGgx<double> lobe{0.15, 0.3, 0.1};
  const double theta_i = 0.7;
  const BrdfFunction f = [&](const glm::vec3& wi, const glm::vec3& wo) {
    const double p = 0.4 * cosine_pdf(double(wo.z)) + 0.6 * lobe.pdf(glm::dvec3(wi), glm::dvec3(wo));
    return glm::vec3(glm::dvec3(p / wo.z));
  };
  const detail::Quadrature q = detail::quadrature(f, theta_i);
  const detail::Proposal start =
      detail::albedo_proposal(parse_model("lambert:albedo=0.3+ggx:alpha=0.6,F0=1,F90=1"), theta_i, 0.01);
  const detail::Proposal found = detail::refine_proposal(q, start, true, 0.01);
  EXPECT_GT(detail::relative_variance(q, start), 0.5);
  EXPECT_LT(detail::relative_variance(q, found), 1e-3);
  EXPECT_NEAR(found.weight[1], 0.6, 0.006);
  EXPECT_NEAR(found.shape[0].alpha_x, 0.15, 0.0015);
  EXPECT_NEAR(found.shape[0].alpha_y, 0.3, 0.003);
  EXPECT_NEAR(found.shape[0].shear, 0.1, 0.001);
}

}  // namespace
}  // namespace gonio
