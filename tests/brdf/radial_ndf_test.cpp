#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>

#include <gonio/brdf/ndf/image/shadowing.h>
#include <gonio/brdf/ndf/radial_ndf.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/ndf_cases.h"

namespace gonio {
namespace {

using namespace test;

constexpr double degree = pi<double> / 180;

template <class Ndf>
RadialNdf radial(const Ndf& ndf) {
  return RadialNdf(512, [&](double theta) { return ndf(at(theta, 0)); });
}

template <class Ndf>
void expect_closed_form(const Ndf& analytic) {
  RadialNdf d = radial(analytic);
  EXPECT_NEAR(d.normalise(), 1, 2e-3);
  EXPECT_NEAR(d.projected_area(), 1, 1e-12);
  for (double t = 0; t <= 85; t += 2.5) EXPECT_NEAR(d.g1(t * degree), analytic.g1(at(t * degree, 0)), 1e-3) << t;
}

TEST(RadialNdf, G1OfGgxAndBeckmann) {
  for (const double a : {0.005, 0.02, 0.1, 0.5, 1.0}) {
    SCOPED_TRACE(a);
    expect_closed_form(GgxNdf{a, a});
    expect_closed_form(BeckmannNdf{a, a});
    EXPECT_NEAR(std::tan(radial(GgxNdf{a, a}).median_theta()) / a, 1, 0.02);
    EXPECT_NEAR(std::tan(radial(BeckmannNdf{a, a}).median_theta()) / (a * std::sqrt(std::log(2))), 1, 0.02);
  }
}

TEST(RadialNdf, AgreesWithTheImage) {
  RadialNdf d = radial(GgxNdf{0.3, 0.3});
  d.normalise();
  DiskImage image = rasterise(256, [&](const Vec3<double>& h) { return d.eval(std::acos(h.z)); });
  EXPECT_NEAR(normalise(image), 1, 1e-3);
  const Shadowing shadowing(image);
  for (double t = 0; t <= 85; t += 5) EXPECT_NEAR(shadowing.g1(at(t * degree, 0.7)), d.g1(t * degree), 1e-3) << t;
}

/// Masking and shadowing of two directions that have these G1, and azimuths so far apart.
double g2(Masking masking, double a, double b, double azimuth) {
  if (masking == Masking::height_correlated) return 1 / (1 / a + 1 / b - 1);
  if (masking == Masking::independent) return a * b;
  const double apart = 4.41 * azimuth / (4.41 * azimuth + 1);
  return apart * a * b + (1 - apart) * std::min(a, b);
}

constexpr Masking maskings[] = {Masking::full, Masking::height_correlated, Masking::independent};

/// f_r(k, k) of a microfacet material with F(0) = 0.05.
template <class Ndf>
auto retro_reflection(const Ndf& ndf, Masking masking = Masking::full) {
  return [=](double theta) {
    const Vec3<double> k = at(theta, 0);
    return 0.05 * ndf(k) * g2(masking, ndf.g1(k), ndf.g1(k), 0) / (4 * k.z * k.z);
  };
}

template <class Ndf>
void expect_extracted(const Ndf& analytic, Masking masking) {
  const ExtractedNdf found = extract_ndf(retro_reflection(analytic, masking), masking);
  EXPECT_EQ(found.masking, masking);
  EXPECT_NEAR(found.measured_to, 89 * degree, 0.4 * degree);
  EXPECT_LT(found.change, 1e-9);
  EXPECT_LT(found.iterations, 1000);
  EXPECT_NEAR(found.ndf.projected_area(), 1, 1e-12);
  const double peak = analytic(at(0, 0));
  for (double t = 0; t <= 85; t += 2.5) {
    const double expected = analytic(at(t * degree, 0));
    EXPECT_NEAR(found.ndf.eval(t * degree), expected, 0.005 * expected + 1e-4 * peak) << t;
    EXPECT_NEAR(found.ndf.g1(t * degree), analytic.g1(at(t * degree, 0)), 2e-3) << t;
  }
}

TEST(RadialNdf, ExtractionFindsTheDistribution) {
  for (const double a : {0.01, 0.02, 0.1, 0.4, 0.8, 1.0}) {
    for (const Masking masking : maskings) {
      SCOPED_TRACE(std::to_string(a) + " " + to_string(masking));
      expect_extracted(GgxNdf{a, a}, masking);
      expect_extracted(BeckmannNdf{a, a}, masking);
    }
  }
}

// What was not measured is neither read nor taken for 0: beyond the last angle a GGX goes on as it is.
TEST(RadialNdf, ExtractionFromPartOfTheAngles) {
  for (const double a : {0.1, 0.3, 1.0})
    for (const Masking masking : maskings)
      for (const double last : {30.0, 60.0}) {
        SCOPED_TRACE(std::to_string(a) + " " + to_string(masking) + " to " + std::to_string(last));
        const GgxNdf ggx{a, a};
        const auto whole = retro_reflection(ggx, masking);
        const auto hole = [](double t) { return t < 2 || (t > 20 && t < 22); };
        const ExtractedNdf found = extract_ndf(
            [&](double theta) { return theta > last * degree || hole(theta / degree) ? std::nan("") : whole(theta); },
            masking);
        EXPECT_NEAR(found.measured_to, last * degree, 0.4 * degree);
        // The hole at the pole is filled with the value at its edge.
        EXPECT_NEAR(std::tan(found.ndf.median_theta()) / a, 1, a < 0.2 ? 0.02 : 0.005);
        for (double t = 5; t <= 85; t += 2.5) {
          EXPECT_NEAR(found.ndf.eval(t * degree) / ggx(at(t * degree, 0)), 1, a < 0.2 ? 0.02 : 0.01) << t;
          EXPECT_NEAR(found.ndf.g1(t * degree), ggx.g1(at(t * degree, 0)), 3e-3) << t;
        }
      }
}

/// A microfacet material with Schlick's reflectance, in the layout of a MERL file.
template <class Ndf>
BrdfTable merl_table(const Ndf& ndf, Masking masking, double f0) {
  MerlFile file;
  const std::size_t cells = file.cells();
  file.values.assign(3 * cells, -1.0);
  for (std::size_t i = 0; i < cells; ++i) {
    const auto h = static_cast<double>(i / (180 * 90)), d = static_cast<double>(i / 180 % 90),
               p = static_cast<double>(i % 180);
    glm::vec3 wi, wo;
    const double theta_h = pi<double> / 2 * std::pow((h + 0.5) / 90, 2), theta_d = (d + 0.5) * degree;
    directions_from_half_difference(theta_h, theta_d, (p + 0.5) * degree, wi, wo);
    if (!(wi.z > 0 && wo.z > 0)) continue;
    const auto vec = [](const glm::vec3& w) { return Vec3<double>{w.x, w.y, w.z}; };
    const double azimuth = std::abs(std::remainder(std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x), 2 * pi<double>));
    const double value = (f0 + (1 - f0) * std::pow(1 - std::cos(theta_d), 5)) * ndf(at(theta_h, 0)) *
                         g2(masking, ndf.g1(vec(wi)), ndf.g1(vec(wo)), azimuth) /
                         (4 * static_cast<double>(wi.z) * static_cast<double>(wo.z));
    for (std::size_t c = 0; c < 3; ++c) file.values[c * cells + i] = value / merl_scale[c];
  }
  return BrdfTable(MerlTable(file, {}), {});
}

template <class Ndf>
void expect_extracted_from_table(const Ndf& analytic, Masking masking, double f0) {
  const ExtractedNdf found = extract_ndf(merl_table(analytic, masking, f0));
  if (analytic.ax >= 0.3 && std::is_same_v<Ndf, GgxNdf>) {  // of others the masking hardly shows
    EXPECT_EQ(found.masking, masking);
  }
  const double peak = analytic(at(0, 0));
  EXPECT_NEAR(found.ndf.eval(0) / peak, 1, analytic.ax < 0.1 ? 0.02 : 0.005);  // cells of 0.15 degrees at 0.5
  for (double t = 0; t <= 85; t += 2.5) {
    const double expected = analytic(at(t * degree, 0));
    EXPECT_NEAR(found.ndf.eval(t * degree), expected, 0.02 * expected + 1e-3 * peak) << t;
    EXPECT_NEAR(found.ndf.g1(t * degree), analytic.g1(at(t * degree, 0)), 1e-3) << t;
  }
}

// The masking is not told: the table shows which it is.
TEST(RadialNdf, ExtractionFromTables) {
  for (const double a : {0.01, 0.3, 1.0})
    for (const Masking masking : {Masking::height_correlated, Masking::independent})
      for (const double f0 : {0.02, 1.0}) {
        SCOPED_TRACE(std::to_string(a) + " " + to_string(masking) + " " + std::to_string(f0));
        expect_extracted_from_table(GgxNdf{a, a}, masking, f0);
        expect_extracted_from_table(BeckmannNdf{a, a}, masking, f0);
      }
  // Full masking has an edge at retro-reflection, which a table rounds off.
  for (const double a : {0.1, 0.3, 1.0}) {
    const GgxNdf ggx{a, a};
    const ExtractedNdf found = extract_ndf(merl_table(ggx, Masking::full, 0.5));
    EXPECT_EQ(found.masking, Masking::full);
    EXPECT_NEAR(std::tan(found.ndf.median_theta()) / a, 1, 0.015);
    for (double t = 0; t <= 85; t += 2.5)
      EXPECT_NEAR(found.ndf.g1(t * degree), ggx.g1(at(t * degree, 0)), 6e-3) << a << ' ' << t;
  }
}

// What the eigenvector problem is for: f_r cos^2, the first guess, is far off where shadowing matters.
TEST(RadialNdf, ExtractionBeatsDivisionByCosines) {
  const GgxNdf ggx{0.8, 0.8};
  const auto f_r = retro_reflection(ggx);
  RadialNdf naive(512, [&](double theta) {
    return f_r(std::min(theta, 89 * degree)) * std::pow(std::cos(std::min(theta, 89 * degree)), 2);
  });
  naive.normalise();
  const double t = 60 * degree, expected = ggx(at(t, 0));
  EXPECT_GT(std::abs(naive.eval(t) / expected - 1), 0.1);
  EXPECT_LT(std::abs(extract_ndf(f_r).ndf.eval(t) / expected - 1), 0.01);
}

TEST(RadialNdf, RefusesWhatIsNoDistribution) {
  EXPECT_THROW(RadialNdf(1, [](double) { return 1.0; }), Error);
  EXPECT_THROW(RadialNdf(9, [](double) { return -1.0; }), Error);
  EXPECT_THROW(RadialNdf(9, [](double) { return std::nan(""); }), Error);
  EXPECT_THROW(RadialNdf(9, [](double) { return 0.0; }).normalise(), Error);
  EXPECT_THROW(extract_ndf([](double) { return 0.0; }), Error);
  EXPECT_THROW(extract_ndf([](double) { return std::nan(""); }), Error);
  for (const double bad : {-1.0, std::numeric_limits<double>::infinity()})
    EXPECT_THROW(extract_ndf([=](double) { return bad; }), Error);
  for (const int nodes : {-1, 0, 1}) EXPECT_THROW(extract_ndf([](double) { return 1.0; }, Masking::full, nodes), Error);
}

}  // namespace
}  // namespace gonio
