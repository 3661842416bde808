#define GLM_ENABLE_EXPERIMENTAL  // glm/gtx, for rotations
#include <glm/geometric.hpp>
#include <glm/gtx/rotate_vector.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/formats/merl.h>
#include <gonio/brdf/table/albedo.h>
#include <gonio/mapping/base/error.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using namespace test;

BrdfTable table_of(const MerlFile& file, const CellPolicies& policies = {}) {
  return BrdfTable(MerlTable(file, policies), {});
}

bool below_horizon(int h, int d, int p) {
  const double theta_h = pi / 2 * std::pow((h + 0.5) / 90, 2), theta_d = (d + 0.5) * pi / 180;
  return std::tan(theta_h) * std::tan(theta_d) * std::abs(std::cos((p + 0.5) * pi / 180)) >= 1.0;
}

TEST(Merl, LambertianOfAlbedoOneHalf) {
  const BrdfTable table = table_of(make_merl([](int, int, int) { return 0.5 / pi; }));
  for (const double degrees : {0.0, 2.0, 30.0, 60.0, 85.0}) {
    const glm::vec3 albedo = directional_albedo(table, static_cast<float>(degrees * pi / 180));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], 0.5, 5e-4) << degrees << " degrees";
  }
}

// The definition by two rotations, in double, against the closed form.
TEST(Merl, AnglesAreThoseOfRusinkiewicz) {
  std::mt19937 engine(1);
  for (int i = 0; i < 10000; ++i) {
    const glm::vec3 wi = random_direction(engine), wo = random_direction(engine);
    const glm::dvec3 h = glm::normalize(glm::dvec3(wi) + glm::dvec3(wo));
    const double theta_h = std::acos(h.z), phi_h = std::atan2(h.y, h.x);
    glm::dvec3 d = glm::rotate(glm::dvec3(wi), -phi_h, glm::dvec3(0, 0, 1));
    d = glm::rotate(d, -theta_h, glm::dvec3(0, 1, 0));
    const HalfDifference angles = half_difference(wi, wo);
    EXPECT_NEAR(angles.theta_h, theta_h, 1e-5);
    EXPECT_NEAR(angles.theta_d, std::acos(d.z), 1e-5);
    if (theta_h < 0.05 || d.z > 0.999) continue;  // phi_d is not defined well
    EXPECT_NEAR(std::remainder(angles.phi_d - std::atan2(d.y, d.x), 2 * pi), 0.0, 1e-4);
  }
}

TEST(Merl, NamedPoints) {
  const BrdfTable table = table_of(make_merl([](int h, int d, int p) { return 1000.0 * h + d + 0.001 * p; }));
  // Cell centres of the sqrt-spaced theta_h: (40.5 / 90)^2 * 90 = 18.225 degrees.
  glm::vec3 wi, wo;
  directions_from_half_difference(18.225 * pi / 180, 30.5 * pi / 180, 120.5 * pi / 180, wi, wo);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(table.eval(wi, wo)[c], 40030.12, 0.5);
  // Both directions equal: theta_d = 0, theta_h = theta. Mirror pair: theta_h = 0, theta_d = theta.
  const double theta = 18.225 * pi / 180;
  EXPECT_NEAR(table.eval(direction(theta, 1.0), direction(theta, 1.0)).r, 40000.0, 1.0);
  EXPECT_NEAR(table.eval(direction(40.5 * pi / 180, 1.0), direction(40.5 * pi / 180, 1.0 + pi)).r, 40.0, 0.5);
}

TEST(Merl, InterpolatesHalfWayBetweenCentres) {
  const BrdfTable table = table_of(make_merl([](int, int d, int) { return static_cast<double>(d); }));
  const auto at = [&](double degrees) {
    return table.eval(direction(degrees * pi / 180, 0.0), direction(degrees * pi / 180, pi)).r;
  };
  EXPECT_NEAR(at(41.0), 40.5, 1e-3);
  EXPECT_NEAR(at(41.25), 40.75, 1e-3);
  EXPECT_NEAR(at(0.2), 0.0, 1e-6) << "constant below the first centre";
  EXPECT_NEAR(at(89.8), 89.0, 1e-4) << "constant above the last centre";
}

TEST(Merl, PhiDIsPeriodic) {
  const BrdfTable half = table_of(make_merl([](int, int, int p) { return p == 0 || p == 179; }));
  const BrdfTable full = table_of(make_merl([](int, int, int p) { return p == 0 || p == 359; }, 360));
  const auto at = [](const BrdfTable& table, double phi_d) {
    glm::vec3 wi, wo;
    directions_from_half_difference(0.5, 0.4, phi_d * pi / 180, wi, wo);
    return table.eval(wi, wo).r;
  };
  for (const double phi_d : {-0.5, 0.0, 0.5}) {
    EXPECT_NEAR(at(half, phi_d), 1.0, 1e-3) << phi_d;
    EXPECT_NEAR(at(half, phi_d + 180), 1.0, 1e-3) << phi_d;
    EXPECT_NEAR(at(full, phi_d), 1.0, 1e-3) << phi_d;
    EXPECT_NEAR(at(full, phi_d + 180), 0.0, 1e-3) << phi_d;
  }
  EXPECT_NEAR(at(half, 90.0), 0.0, 1e-3);
}

TEST(Merl, IsotropicAndWith180BinsReciprocal) {
  const auto value = [](int h, int d, int p) { return 1.0 + 0.1 * h + 0.2 * d + 0.01 * p; };
  const BrdfTable half = table_of(make_merl(value)), full = table_of(make_merl(value, 360));
  std::mt19937 engine(2);
  double asymmetry = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 wi = random_direction(engine), wo = random_direction(engine);
    const auto turn = [](const glm::vec3& w) { return glm::rotateZ(w, 2.1f); };
    const float f = half.eval(wi, wo).r;
    EXPECT_NEAR(half.eval(wo, wi).r, f, 1e-2f);
    EXPECT_NEAR(half.eval(turn(wi), turn(wo)).r, f, 1e-2f);
    asymmetry = std::max<double>(asymmetry, std::abs(full.eval(wi, wo).r - full.eval(wo, wi).r));
  }
  EXPECT_GT(asymmetry, 0.5) << "360 bins must be able to hold a material that is not reciprocal";
}

TEST(Merl, AccurateForNearlyEqualDirections) {
  for (const double separation : {1e-2, 1e-3, 1e-4}) {
    const HalfDifference angles = half_difference(direction(0.7, 0.0), direction(0.7 + separation, 0.0));
    EXPECT_NEAR(angles.theta_d / (separation / 2), 1.0, 1e-6 / separation);
    const HalfDifference mirror = half_difference(direction(0.7, 0.0), direction(0.7 + separation, pi));
    EXPECT_NEAR(mirror.theta_h / (separation / 2), 1.0, 1e-6 / separation);
  }
}

TEST(Merl, NothingLeaksAcrossTheHorizon) {
  for (const double outside : {-1.0, 0.0, 1e6}) {
    const MerlTable table(make_merl([&](int h, int d, int p) { return below_horizon(h, d, p) ? outside : 0.5 / pi; }),
                          {});
    EXPECT_EQ(table.cells().missing, 0u);
    std::mt19937 engine(3);
    for (int i = 0; i < 20000; ++i) {
      glm::vec3 wi = random_direction(engine), wo = random_direction(engine);
      if (i % 2 == 0) wo = direction(pi / 2 - 1e-3, wo.x);
      EXPECT_NEAR(table.eval(wi, wo).g, 0.5 / pi, 1e-6);
    }
  }
}

TEST(Merl, MissingCellsFollowThePolicy) {
  const auto value = [](int h, int d, int p) {
    const bool hole = h == 20 && d >= 10 && d < 13 && p == 90;
    return hole ? -1.0 : static_cast<double>(d);
  };
  const MerlFile file = make_merl(value);
  const auto at = [&](const MerlTable& table, int d) {
    glm::vec3 wi, wo;
    directions_from_half_difference(pi / 2 * std::pow(20.5 / 90, 2), (d + 0.5) * pi / 180, 90.5 * pi / 180, wi, wo);
    return table.eval(wi, wo).b;
  };
  CellPolicies policies;
  const MerlTable filled(file, policies);
  EXPECT_EQ(filled.cells().missing, 3u);
  EXPECT_EQ(filled.cells().total, 90u * 90 * 180);
  EXPECT_NEAR(at(filled, 10), 9.0, 1e-2);
  EXPECT_NEAR(at(filled, 11), 9.0, 1e-2) << "the lower index at equal distance";
  EXPECT_NEAR(at(filled, 12), 13.0, 1e-2);
  policies.missing = CellPolicy::zero;
  EXPECT_NEAR(at(MerlTable(file, policies), 11), 0.0, 1e-2);
  policies.missing = CellPolicy::reject;
  EXPECT_THROW(MerlTable(file, policies), Error);
}

TEST(Merl, NonfiniteCellsAreFilledAndCounted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MerlTable table(make_merl([&](int, int d, int) { return d == 45 ? nan : 1.0; }), {});
  EXPECT_GT(table.cells().nonfinite, 0u);
  EXPECT_NEAR(table.eval(direction(0.79, 0.0), direction(0.79, pi)).r, 1.0, 1e-6);
  EXPECT_THROW(MerlTable(make_merl([&](int, int, int) { return nan; }), {}), Error);
}

TEST(Merl, RoundTripKeepsEveryByte) {
  const TemporaryFolder folder;
  for (const int n_phi_d : {180, 360}) {
    MerlFile file = make_merl([](int h, int d, int p) { return std::sin(h + d * p) * 1e3; }, n_phi_d);
    file.values[5] = -std::numeric_limits<double>::quiet_NaN();
    file.values[6] = std::numeric_limits<double>::denorm_min();
    write_merl(folder / "a", file);
    EXPECT_EQ(std::filesystem::file_size(folder / "a"), n_phi_d == 180 ? 34992012u : 69984012u);
    write_merl(folder / "b", read_merl(folder / "a"));
    EXPECT_TRUE(file_bytes(folder / "a") == file_bytes(folder / "b"));
  }
}

TEST(Merl, BadFilesAreNamed) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& bytes) -> std::string {
    write_file(folder / "bad.binary", bytes);
    try {
      read_merl(folder / "bad.binary");
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  std::string header;
  for (const std::int32_t n : {90, 90, 180}) append(header, n);
  EXPECT_THAT(message(""), AllOf(HasSubstr("bad.binary: header"), HasSubstr("0 bytes")));
  EXPECT_THAT(message(header), AllOf(HasSubstr("file size: found 12 bytes"), HasSubstr("34992012")));
  std::string other;
  for (const std::int32_t n : {90, 2147483647, -1}) append(other, n);
  EXPECT_THAT(message(other), HasSubstr("dimensions: found 90 x 2147483647 x -1, expected 90 x 90"));
}

}  // namespace
}  // namespace gonio
