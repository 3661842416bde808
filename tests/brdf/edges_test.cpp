// The sides of the unit square, where random numbers hardly come: see brdf/proof/edges.h.

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <regex>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/brdf/build/compact/fit_compact.h>
#include <gonio/brdf/build/stack/build_stack.h>
#include <gonio/brdf/proof/edges.h>
#include <gonio/brdf/proof/gallery.h>
#include <gonio/brdf/proof/samplers/baseline.h>
#include <gonio/fitting/fit/fit.h>
#include <gonio/fitting/model/model.h>
#include <gonio/fitting/sampling/lobe_sampler.h>
#include <gonio/mapping/light/emission.h>
#include <gonio/mapping/light/exr/light_exr.h>

#include "tests/support/batch_subject.h"
#include "tests/support/files.h"

namespace gonio::proof {
namespace {

constexpr double degree = pi<double> / 180;

std::shared_ptr<const BrdfTable> table(const std::string& name) {
  for (const GalleryTable& entry : gallery_tables())
    if (entry.name == name) return std::make_shared<const BrdfTable>(to_table(entry));
  throw std::logic_error("the Gallery has no table " + name);
}

void expect_sound(const std::string& what, const Subject& subject, double theta_i) {
  const EdgeScan scan = scan_edges(subject, theta_i);
  EXPECT_EQ(scan.bad, 0u) << what << ", " << theta_i / degree << " degrees, " << scan.where_bad;
  EXPECT_LE(scan.pdf_factor, 1.1) << what << ", " << theta_i / degree << " degrees, " << scan.where_pdf;
  EXPECT_LE(scan.largest_weight, 2) << what << ", " << theta_i / degree << " degrees, " << scan.where_weight;
}

/// Everything that a table is sampled by.
void expect_all_sound(const std::string& name, const std::shared_ptr<const BrdfTable>& from,
                      const std::vector<double>& angles) {
  const CompactFit fit = fit_compact(*from).best();
  const Bsdf bsdf(fit.data, from), compact(fit.data);
  const StackBsdf plain(fit.data, from), plain_compact(fit.data);
  for (const double theta_i : angles) {
    expect_sound(name + ", plain", subject_of(plain), theta_i);
    expect_sound(name + ", plain, compact", subject_of(plain_compact), theta_i);
    expect_sound(name + ", one", subject_of(bsdf), theta_i);
    expect_sound(name + ", batch", batch_subject(bsdf), theta_i);
    expect_sound(name + ", compact, one", subject_of(compact), theta_i);
    expect_sound(name + ", compact, batch", batch_subject(compact), theta_i);
    const DirectionScan directions = scan_directions(subject_of(bsdf), theta_i);
    EXPECT_LE(directions.largest_weight, 50) << name << ", " << theta_i / degree << " degrees, " << directions.where;
    EXPECT_EQ(directions.without_pdf, 0) << name << ", " << theta_i / degree << " degrees";
  }
  if (!std::get_if<RglTable>(&from->data())) return;
  const RglSampler chain(from);
  for (const double theta_i : angles) {
    const EdgeScan scan = scan_edges(subject_of(chain), theta_i);
    EXPECT_EQ(scan.bad, 0u) << name << ", RGL's chain, " << scan.where_bad;
    EXPECT_LE(scan.pdf_factor, 1.2) << name << ", RGL's chain, " << theta_i / degree << ", " << scan.where_pdf;
    EXPECT_LE(scan.largest_weight, 4) << name << ", RGL's chain, " << theta_i / degree << ", " << scan.where_weight;
  }
}

TEST(Edges, WhatATableIsSampledBy) { expect_all_sound("specular", table("specular"), {0, 0.4, 1.0, 1.4, 1.55}); }

TEST(Edges, Lobes) {
  const auto from = table("specular");
  const LobeSampler lobes(from, fit(measured_part(*from), parse_model("ggx+lambert")).model);
  for (const double theta_i : {0.0, 0.8, 1.5}) expect_sound("lobes", subject_of(lobes), theta_i);
}

// All measured files: slow, since stacks are built. The files of MERL's format are surrogates that a script writes.
class MeasuredEdges : public testing::TestWithParam<const char*> {};
TEST_P(MeasuredEdges, AreSound) {
  if (test::test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const std::filesystem::path path = test::test_data() / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path.string() << " is not there";
  std::vector<double> angles;
  for (const double theta_i : {0.0, 2.0, 10.0, 30.0, 50.0, 70.0, 80.0, 85.0, 88.3}) angles.push_back(theta_i * degree);
  expect_all_sound(GetParam(), std::make_shared<const BrdfTable>(load_table(path)), angles);
}
/// Stacks for displacement: up to three times the interior's weight, in half vectors six times.
TEST_P(MeasuredEdges, AreSoundBetweenDiagrams) {
  if (test::test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const std::filesystem::path path = test::test_data() / GetParam();
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path.string() << " is not there";
  const auto from = std::make_shared<const BrdfTable>(load_table(path));
  for (const Chart chart : charts) {
    BsdfOptions options;
    options.interpolation = Interpolation::displacement;
    options.chart = chart;
    const StackGrid grid = build_stack(*from, options);
    for (const Interpolation interpolation : {Interpolation::displacement, Interpolation::nearest}) {
      const Bsdf bsdf({grid, interpolation, {}}, from);
      for (const double theta_i : {0.0, 2.0, 10.0, 30.0, 50.0, 70.0, 80.0, 85.0}) {
        const EdgeScan scan = scan_edges(subject_of(bsdf), theta_i * degree);
        const auto where = [&](const std::string& uv) {
          return GetParam() + std::string(", ") + to_string(interpolation) + ", " + to_string(chart) + ", " +
                 std::to_string(theta_i) + " degrees, " + uv;
        };
        EXPECT_EQ(scan.bad, 0u) << where(scan.where_bad);
        EXPECT_LE(scan.pdf_factor, 1.1) << where(scan.where_pdf);
        EXPECT_LE(scan.largest_weight, chart == Chart::half ? 6 : 3) << where(scan.where_weight);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Slow, MeasuredEdges,
                         testing::Values("rgl/paper_white_rgb.bsdf", "rgl/satin_rosaline_rgb.bsdf",
                                         "rgl/cc_iris_purple_gem_rgb.bsdf", "rgl/cg_sunflower_rgb.bsdf",
                                         "rgl_more/aurora_white_rgb.bsdf", "rgl_more/cc_green_malachite_rgb.bsdf",
                                         "rgl_more/chm_orange_rgb.bsdf", "rgl_more/ilm_solo_m_68_rgb.bsdf",
                                         "rgl_more/irid_flake_paint1_rgb.bsdf", "rgl_more/vch_silk_blue_rgb.bsdf",
                                         "mbsdf/carpaint_blue.mbsdf", "mbsdf/carpaint_red.mbsdf", "merl/chrome.binary",
                                         "merl/blue-acrylic.binary", "merl/gold-metallic-paint.binary",
                                         "merl/yellow-matte-plastic.binary"),
                         [](const auto& entry) {
                           return std::regex_replace(std::filesystem::path(entry.param).stem().string(),
                                                     std::regex("-"), "_");
                         });

/// @returns the draws without a direction.
std::uint64_t expect_emission_sound(const std::string& what, const LightDiagram& diagram) {
  const EmissionSampler<float> sampler(diagram);
  Subject subject;
  subject.sample = [&](const glm::vec3&, const glm::vec2& u) -> std::optional<BsdfSample> {
    const auto s = sampler.sample(u.x, u.y);
    if (!(s.pdf > 0)) return std::nullopt;
    return BsdfSample{s.direction, s.pdf, glm::vec3(s.weight)};
  };
  subject.pdf = [&](const glm::vec3&, const glm::vec3& w) { return static_cast<double>(sampler.pdf(w)); };
  EdgeOptions options;
  options.domain = Domain::sphere;
  const EdgeScan scan = scan_edges(subject, 0, options);
  EXPECT_EQ(scan.bad, 0u) << what << ", " << scan.where_bad;
  EXPECT_LE(scan.pdf_factor, 1.1) << what << ", " << scan.where_pdf;
  EXPECT_LE(scan.largest_weight, 2) << what << ", " << scan.where_weight;
  return scan.empty;
}

// A Lambertian opening is dark at its edge, a cone at both poles, and a beam ends at a parallel.
TEST(Edges, Emission) {
  const auto luminaire = [](double last, const std::function<double(double)>& cd) {
    LightDiagram d;
    for (int i = 0; i <= 24; ++i) d.c.push_back(2 * pi<double> * i / 24);
    for (int j = 0; j <= 36; ++j) d.gamma.push_back(last * j / 36);
    d.c.back() = 2 * pi<double>, d.gamma.back() = last;
    for (std::size_t i = 0; i < d.c.size(); ++i)
      for (const double gamma : d.gamma) d.cd.push_back(std::max(0.0, cd(gamma)));
    return d;
  };
  for (const LightDiagram& d : {luminaire(pi<double> / 2, [](double g) { return 100 * std::cos(g); }),
                                luminaire(pi<double>, [](double g) { return 100 * std::sin(g) * std::sin(g); }),
                                luminaire(pi<double>, [](double g) { return g < 2 ? 100 * (2 - g) : 0; })})
    EXPECT_EQ(expect_emission_sound("luminaire", d), 0u);
}

TEST(SlowEdges, MeasuredLuminaires) {
  if (test::test_data().empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  int sampled = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::test_data() / "photometric")) {
    if (!entry.is_regular_file() || entry.path().filename() == "test_file_format_error.ies" ||
        !is_light_file(entry.path()))
      continue;
    Problems ignored;
    // Draws on the very side of a plane without light are empty.
    EXPECT_LE(
        expect_emission_sound(entry.path().filename().string(), load_any_light(entry.path(), {}, ignored).diagram),
        100u)
        << entry.path();
    ++sampled;
  }
  EXPECT_GE(sampled, 40);
}

// Negative controls: faults within 2^-20 of a side are found, and by the number that is there for them.
TEST(Edges, FaultsNextToASideAreFound) {
  const CosineSampler right(table("lambert"));
  const auto with = [&](const std::function<void(BsdfSample&)>& fault) {
    Subject subject = subject_of(right);
    subject.sample = [&right, fault](const glm::vec3& wi, const glm::vec2& u) {
      auto s = right.sample(wi, u);
      if (s && u.x < 0x1p-20f) fault(*s);
      return s;
    };
    return scan_edges(subject, 0.5);
  };
  const EdgeScan sound = with([](BsdfSample&) {});
  EXPECT_EQ(sound.bad, 0u);
  EXPECT_LT(sound.pdf_factor, 1.01);
  EXPECT_LT(sound.largest_weight, 1.01);
  EXPECT_GT(with([](BsdfSample& s) { s.wo.z = 0; }).bad, 0u);
  EXPECT_GT(with([](BsdfSample& s) { s.pdf *= 2; }).pdf_factor, 1.9);
  EXPECT_GT(with([](BsdfSample& s) { s.weight *= 3; }).largest_weight, 2.9);
}

TEST(Edges, DirectionsWithoutDensityAreFound) {
  const CosineSampler right(table("lambert"));
  EXPECT_NEAR(scan_directions(subject_of(right), 0.5).largest_weight, 1, 1e-3);
  Subject subject = subject_of(right);
  subject.pdf = [&](const glm::vec3& wi, const glm::vec3& wo) {
    return wo.z < 0x1p-10f ? 1e-3 * right.pdf(wi, wo) : right.pdf(wi, wo);
  };
  EXPECT_NEAR(scan_directions(subject, 0.5).largest_weight, 1000, 1);
  subject.pdf = [&](const glm::vec3& wi, const glm::vec3& wo) { return wo.x > 0 ? 0 : right.pdf(wi, wo); };
  EXPECT_NEAR(scan_directions(subject, 0.5).without_pdf, 0.5, 0.01);
}

// No float in, whatever it is, does more than return nothing.
TEST(Edges, HostileFloats) {
  const auto from = table("specular");
  const BsdfData data = fit_compact(*from).best().data;
  const Bsdf bsdf(data, from), compact(data);
  const StackBsdf plain(data, from), plain_compact(data);
  const Subject subjects[] = {subject_of(plain),   subject_of(plain_compact), subject_of(bsdf),
                              batch_subject(bsdf), subject_of(compact),       batch_subject(compact)};
  using Limits = std::numeric_limits<float>;
  const float hostile[] = {Limits::quiet_NaN(),
                           Limits::infinity(),
                           -Limits::infinity(),
                           Limits::max(),
                           -Limits::max(),
                           Limits::denorm_min(),
                           -Limits::denorm_min(),
                           Limits::min(),
                           0.0f,
                           -0.0f,
                           -1.0f,
                           2.0f,
                           1e-30f,
                           1e30f};
  for (const Subject& subject : subjects) {
    for (int first = 0; first < 6; ++first)
      for (int second = first; second < 6; ++second)
        for (const float a : hostile)
          for (const float b : hostile) {
            float x[] = {0.5f, 0, 0.8660254f, -0.5f, 0, 0.8660254f};  // wi, and wo or (u, v)
            x[first] = a, x[second] = b;
            const glm::vec3 wi(x[0], x[1], x[2]), wo(x[3], x[4], x[5]);
            const double pdf = subject.pdf(wi, wo);
            const glm::vec3 f_r = subject.f_r(wi, wo);
            ASSERT_TRUE(pdf >= 0 && std::isfinite(pdf)) << first << ' ' << a << ' ' << second << ' ' << b;
            ASSERT_TRUE(f_r.x >= 0 && std::isfinite(f_r.x + f_r.y + f_r.z))
                << first << ' ' << a << ' ' << second << ' ' << b;
            const auto s = subject.sample(wi, {x[3], x[4]});
            const bool sound = !s || (s->pdf > 0 && std::isfinite(s->wo.x + s->wo.y + s->wo.z + s->weight.x));
            ASSERT_TRUE(sound) << first << ' ' << a << ' ' << second << ' ' << b;
          }
  }
}

}  // namespace
}  // namespace gonio::proof
