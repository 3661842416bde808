// Which cells of a table were measured, and how far from the normal.

#include <gtest/gtest.h>

#include <gonio/brdf/formats/repair.h>
#include <gonio/brdf/table/measured_to.h>
#include <gonio/fitting/model/synth.h>

#include "tests/support/table_files.h"

namespace gonio {
namespace {

using test::append;
using test::direction;
using test::make_merl;
using test::make_rgl;
using test::random_direction;
using test::TensorBuilder;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double degree = pi<double> / 180;

BrdfTable table_of(const MbsdfFile& file, const CellPolicies& policies = {}) {
  return BrdfTable(MbsdfTable(file, policies), {});
}

BrdfTable table_of(const MerlFile& file, const CellPolicies& policies = {}) {
  return BrdfTable(MerlTable(file, policies), {});
}

MbsdfFile grid_of(int n_theta, int n_phi) {
  return synthesize_mbsdf(parse_model("lambert:albedo=0.5"), n_theta, n_phi);
}

SynthOptions measured_to(double degrees) {
  SynthOptions options;
  options.measured_to = degrees * degree;
  return options;
}

TEST(Measured, OriginsFollowThePolicies) {
  using K = CellKind;
  using O = CellOrigin;
  EXPECT_TRUE(cell_origins({K::valid, K::negative}, {}).empty());
  const std::vector<K> kinds = {K::valid, K::negative, K::nonfinite, K::missing, K::outside};
  EXPECT_EQ(cell_origins(kinds, {}), (std::vector<O>{O::measured, O::measured, O::made_up, O::made_up, O::outside}));
  const CellPolicies zero{CellPolicy::zero, CellPolicy::zero, CellPolicy::zero};
  EXPECT_EQ(cell_origins(kinds, zero), cell_origins(kinds, {}));  // black is made up as well
  CellPolicies fill;
  fill.negative = CellPolicy::fill;
  EXPECT_EQ(cell_origins(kinds, fill)[1], O::made_up);
}

// One cell of a grid with centres at 7.5, 22.5, ... degrees is not a number: its weight is that of
// interpolation, in all three coordinates.
TEST(Measured, ShareIsThatOfTheInterpolation) {
  MbsdfFile file = grid_of(6, 6);
  for (int c = 0; c < 3; ++c) file.values[static_cast<std::size_t>((1 * 6 + 2) * 6 + 3) * 3 + c] = nan;
  const BrdfTable table = table_of(file);
  const auto share = [&](double i, double o, double phi) {
    return table.measured(direction(i * degree, 0), direction(o * degree, phi * degree));
  };
  EXPECT_NEAR(share(22.5, 37.5, 105), 0, 1e-5);
  EXPECT_NEAR(share(22.5 + 7.5, 37.5, 105), 0.5, 1e-5);
  EXPECT_NEAR(share(22.5, 37.5 - 3.75, 105), 0.25, 1e-5);
  EXPECT_NEAR(share(22.5, 37.5, 105 + 22.5), 0.75, 1e-5);
  EXPECT_NEAR(share(22.5 + 7.5, 37.5 + 7.5, 105 + 15), 0.875, 1e-5);
  EXPECT_EQ(share(22.5 + 15, 37.5, 105), 1);
  EXPECT_EQ(share(80, 10, 0), 1);
  EXPECT_EQ(table.measured({0, 0, 1}, {0.6f, 0, -0.8f}), 0);
}

TEST(Measured, CompleteTablesAreMeasuredEverywhere) {
  const BrdfTable tables[] = {table_of(grid_of(5, 7)), table_of(make_merl([](int, int, int) { return 0.1; })),
                              table_of(make_merl([](int, int, int) { return 0.1; }, 360))};
  std::mt19937 engine(3);
  for (const BrdfTable& table : tables) {
    EXPECT_NEAR(measured_to(table), 90 * degree, 1e-9);
    for (int k = 0; k < 10000; ++k) EXPECT_EQ(table.measured(random_direction(engine), random_direction(engine)), 1);
  }
}

TEST(Measured, RangeIsThatOfTheSynthesis) {
  const LobeModel model = parse_model("ggx:alpha=0.3");
  for (const double to : {5.0, 30.0, 60.0, 81.0}) {
    const BrdfTable tables[] = {table_of(synthesize_mbsdf(model, 90, 36, measured_to(to))),
                                table_of(synthesize_merl(model, measured_to(to)))};
    for (const BrdfTable& table : tables) EXPECT_NEAR(measured_to(table) / degree, to, 1e-9);
  }
  // Cells of 7.5 degrees end at the angle, or around it.
  EXPECT_NEAR(measured_to(table_of(synthesize_mbsdf(model, 12, 8, measured_to(30)))) / degree, 30, 1e-9);
  EXPECT_NEAR(measured_to(table_of(synthesize_mbsdf(model, 12, 8, measured_to(28)))) / degree, 30, 1e-9);
}

// Holes do not end the range as long as they are the lesser part.
TEST(Measured, HolesAreNoEnd) {
  MbsdfFile file = grid_of(30, 30);
  for (std::size_t k = 0; k < file.values.size(); k += 3)
    if (k % 9 == 0) file.values[k + 1] = nan;
  EXPECT_NEAR(measured_to(table_of(file)), 90 * degree, 1e-9);
  for (std::size_t k = 0; k < file.values.size(); k += 3)
    if (k % 9 == 3) file.values[k] = nan;
  EXPECT_EQ(measured_to(table_of(file)), 0);  // a third of the cells is left
}

TEST(Measured, RglBetweenItsIncidentAngles) {
  TensorBuilder file = make_rgl();
  file["theta_i"].data.clear();
  for (const float theta : {0.1f, 0.8f, 1.4f}) append(file["theta_i"].data, theta);
  Problems problems;
  const RglTable table(parse_rgl(file.bytes(), problems), {});
  ASSERT_TRUE(problems.empty());
  const glm::vec3 wo = direction(0.5, 1);
  EXPECT_EQ(table.measured(direction(0.05, 0), wo), 0);
  EXPECT_EQ(table.measured(direction(0.1, 0), wo), 1);
  EXPECT_EQ(table.measured(direction(1.4, 0), wo), 1);
  EXPECT_EQ(table.measured(direction(1.45, 0), wo), 0);
  EXPECT_NEAR(measured_to(BrdfTable(table, {})) / degree, 1.4 / degree, 1);
}

// A node that is not a number takes the place of its neighbour's value and has its weight.
TEST(Measured, RglNodes) {
  TensorBuilder file = make_rgl();
  std::string& colours = file["rgb"].data;  // [theta_i][channel][3][2]
  std::memcpy(&colours[4 * (18 + 2)], &nan, 4);
  Problems problems;
  const RglTable table(parse_rgl(file.bytes(), problems), {});
  EXPECT_EQ(table.cells().nonfinite, 1u);
  float least = 1, most = 0;
  std::mt19937 engine(7);
  for (int k = 0; k < 10000; ++k) {
    const float share = table.measured(random_direction(engine), random_direction(engine));
    least = std::min(least, share), most = std::max(most, share);
  }
  EXPECT_LT(least, 0.1f);
  EXPECT_GT(most, 0.9999f);
}

}  // namespace
}  // namespace gonio
