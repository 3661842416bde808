#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/code16.h>
#include <gonio/mapping/stack/rounded16.h>

namespace gonio {
namespace {

TEST(Code16, EveryCodeComesBack) {
  float last = -1;
  for (int code = 0; code <= peak_code16; ++code) {
    const float value = decode16(static_cast<std::uint16_t>(code));
    ASSERT_GT(value, last) << code;
    ASSERT_EQ(encode16(value), code);
    last = value;
  }
  EXPECT_EQ(decode16(0), 0.0f);
  EXPECT_EQ(decode16(peak_code16), 1.0f);
}

// By the definition of IEEE half floats: 10 bits behind the 1, exponents down to -14, below that steps of 2^-24.
TEST(Code16, IsAHalfFloat) {
  for (int code = 0; code <= peak_code16; ++code) {
    const int exponent = code >> 10, mantissa = code & 1023;
    const double half = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
    ASSERT_EQ(decode16(static_cast<std::uint16_t>(code)), half * 0x1p-15) << code;
  }
}

TEST(Code16, RoundsWithinTheStatedBound) {
  for (double value = 1; value > 1e-15; value *= 0.9987) {
    const double error = std::abs(decode16(encode16(value)) - value);
    EXPECT_LE(error, value > 0x1p-29 ? 0x1p-11 * value : value > 0x1p-39 ? 0x1p-40 : 0x1p-39) << value;
    EXPECT_GT(encode16(value), 0) << value;
  }
  EXPECT_EQ(encode16(0), 0);
  EXPECT_EQ(encode16(1), peak_code16);
  EXPECT_EQ(encode16(std::numeric_limits<double>::denorm_min()), 1);
}

/// A lobe over a base, `incident` diagrams on shared irregular lines.
StackGrid lobe(Chart chart, int incident, int meridians, int parallels, double width = 0.1, double base = 0.02) {
  StackGrid stack;
  stack.chart = chart;
  for (int k = 0; k < incident; ++k) {
    const double theta = 1.5 * k / std::max(incident - 1, 1);
    DiagramGrid d;
    for (int i = 0; i < meridians; ++i) d.phi.push_back(pi<double> * std::pow(i / (meridians - 1.0), 0.8));
    for (int j = 0; j < parallels; ++j) d.r.push_back(std::pow(j / (parallels - 1.0), 1.3));
    const double at = chart == Chart::half ? 0 : std::sqrt(1 - std::cos(theta));
    for (const double phi : d.phi)
      for (const double r : d.r) {
        const double x = r * std::cos(phi) + at, y = r * std::sin(phi);
        d.density.push_back(3 * (k + 1) *
                            (std::exp(-(x * x + y * y) / (width * width)) + base * (1.1 + std::cos(phi) * r)));
      }
    stack.theta_i.push_back(theta);
    stack.diagrams.push_back(std::move(d));
  }
  return stack;
}

class Rounded : public testing::TestWithParam<Chart> {};
INSTANTIATE_TEST_SUITE_P(Charts, Rounded, testing::ValuesIn(charts),
                         [](const auto& chart) { return std::string(to_string(chart.param)); });

TEST_P(Rounded, IsNearTheStackGiven) {
  const StackGrid grid = lobe(GetParam(), 5, 20, 40);
  const Stack<double> stack(grid, Interpolation::blend), rounded(rounded16(grid), Interpolation::blend);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> random;
  constexpr int draws = 4000;
  double sum2 = 0;
  for (int n = 0; n < draws; ++n) {
    const double theta_i = 1.3 * random(engine), u = random(engine);
    const auto s = rounded.sample(theta_i, u, random(engine));
    const double ratio = stack.pdf(theta_i, s.wo) / s.pdf;
    ASSERT_NEAR(ratio, 1, 0x1p-10) << theta_i;
    sum2 += std::pow(ratio - 1, 2);
  }
  EXPECT_LT(sum2 / draws, 2e-7);  // the variance of the weights
}

TEST_P(Rounded, RoundingAgainGivesTheSameBits) {
  const StackGrid grid = rounded16(lobe(GetParam(), 4, 9, 21, 0.01, 1e-9)), again = rounded16(grid);
  EXPECT_EQ(grid.theta_i, again.theta_i);
  EXPECT_EQ(grid.chart, again.chart);
  for (std::size_t k = 0; k < grid.diagrams.size(); ++k) {
    EXPECT_EQ(grid.diagrams[k].phi, again.diagrams[k].phi);
    EXPECT_EQ(grid.diagrams[k].r, again.diagrams[k].r);
    EXPECT_EQ(grid.diagrams[k].density, again.diagrams[k].density);
  }
}

TEST_P(Rounded, IntegratesToOne) {
  for (const DiagramGrid& d : rounded16(lobe(GetParam(), 5, 12, 20, 0.3)).diagrams) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < d.phi.size(); ++i)
      for (std::size_t j = 0; j + 1 < d.r.size(); ++j)
        for (const std::size_t side : {i, i + 1})
          sum += (d.phi[i + 1] - d.phi[i]) / 2 *
                 RadialCell<double>{d.r[j], d.r[j + 1] - d.r[j], d.at(side, j), d.at(side, j + 1)}.mass(1);
    EXPECT_NEAR(2 * sum, 1, 2e-7);
  }
}

// Codes of the largest density are those that it is divided by: nothing above it, and zeros stay zeros.
TEST(Rounded16, EveryDensityIsACode) {
  StackGrid grid = lobe(Chart::outgoing, 3, 8, 40);
  for (DiagramGrid& d : grid.diagrams)
    for (std::size_t j = 10; j < 20; ++j) d.at(3, j) = 0;
  for (const DiagramGrid& d : rounded16(grid).diagrams) {
    const double largest = *std::max_element(d.density.begin(), d.density.end());
    for (const double density : d.density) EXPECT_EQ(decode16(encode16(density / largest)) * largest, density);
    for (std::size_t j = 10; j < 20; ++j) EXPECT_EQ(d.at(3, j), 0);
  }
}

TEST(Rounded16, BadInput) {
  const StackGrid good = lobe(Chart::half, 3, 8, 8);
  const auto message = [](const StackGrid& grid) -> std::string {
    try {
      rounded16(grid);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message(good), "");
  StackGrid bad = good;
  bad.theta_i[1] = 3;
  EXPECT_NE(message(bad).find("theta_i[1]"), std::string::npos);
  bad = good, bad.diagrams[2].density[5] = std::nan("");
  EXPECT_NE(message(bad).find("density[5]"), std::string::npos);
  bad = good, bad.diagrams[2].density.assign(64, 0);
  EXPECT_NE(message(bad).find("zero everywhere"), std::string::npos);
  EXPECT_NE(message({}).find("0 incident angles"), std::string::npos);
}

}  // namespace
}  // namespace gonio
