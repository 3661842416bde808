#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/code16.h>
#include <gonio/mapping/stack/packed_stack.h>

namespace gonio {
namespace {

TEST(Code16, EveryCodeComesBack) {
  float last = -1;
  for (int code = 0; code < 65536; ++code) {
    const float value = decode16(static_cast<std::uint16_t>(code));
    ASSERT_GT(value, last) << code;
    ASSERT_EQ(encode16(value), code);
    last = value;
  }
  EXPECT_EQ(decode16(0), 0.0f);
  EXPECT_EQ(decode16(peak_code16), 1.0f);
  EXPECT_LT(last, 2.0f);
}

TEST(Code16, RoundsWithinTheStatedBound) {
  for (double value = 1; value > 1e-15; value *= 0.9987) {
    const double error = std::abs(decode16(encode16(value)) - value);
    EXPECT_LE(error, value > 0x1p-42 ? 0x1p-12 * (value + 0x1p-31) * 1.001 : 0x1p-42) << value;
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

constexpr float angles[] = {0, 0.05f, 0.3f, 0.75f, 1.3f, 1.5f, 1.57f};

class Packed : public testing::TestWithParam<Chart> {};
INSTANTIATE_TEST_SUITE_P(Charts, Packed, testing::ValuesIn(charts),
                         [](const auto& chart) { return std::string(to_string(chart.param)); });

// A block is not full, full, and one cell more; and the fewest lines.
constexpr int parallels_tried[] = {2, 3, 8, 9, 10, 17, 33, 40};

TEST_P(Packed, IsTheStackOfItsOwnGrid) {
  for (const int parallels : parallels_tried) {
    const PackedStack packed(lobe(GetParam(), 5, 12, parallels));
    const Stack<double> stack(packed.grid(), Interpolation::blend);
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> random;
    for (int n = 0; n < 4000; ++n) {
      const float theta_i = angles[n % 7], u = random(engine), v = random(engine);
      // Beyond, the half-vector chart magnifies the rounding of wo by 1 / cos theta_i.
      if (GetParam() == Chart::half && theta_i > 1.5f) continue;
      const auto s = packed.sample(theta_i, u, v);
      const auto expected = stack.sample(theta_i, u, v);
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_NEAR(s.wo[axis], expected.wo[axis], 1e-4) << parallels << ' ' << theta_i << ' ' << u << ' ' << v;
      const double pdf = stack.pdf(theta_i, Vec3<double>(s.wo.x, s.wo.y, s.wo.z));
      ASSERT_NEAR(packed.pdf(theta_i, s.wo) / pdf, 1, 4e-5) << parallels << ' ' << theta_i;
      ASSERT_NEAR(s.pdf / pdf, 1, 1e-4) << parallels << ' ' << theta_i;
    }
  }
}

TEST_P(Packed, IsNearTheStackOfTheGridGiven) {
  const StackGrid grid = lobe(GetParam(), 5, 20, 40);
  const PackedStack packed(grid);
  const Stack<double> stack(grid, Interpolation::blend);
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> random;
  constexpr int draws = 4000;
  double sum2 = 0;
  for (int n = 0; n < draws; ++n) {
    const float theta_i = angles[n % 5];
    const auto s = packed.sample(theta_i, random(engine), random(engine));
    const double pdf = stack.pdf(theta_i, Vec3<double>(s.wo.x, s.wo.y, s.wo.z));
    ASSERT_NEAR(packed.pdf(theta_i, s.wo) / pdf, 1, 0x1p-11 + 2e-5) << theta_i;
    sum2 += std::pow(pdf / s.pdf - 1, 2);
  }
  EXPECT_LT(sum2 / draws, 1e-7);  // the variance of the weights
}

TEST_P(Packed, ComesBack) {
  for (const int parallels : parallels_tried) {
    const PackedStack packed(lobe(GetParam(), 5, 12, parallels));
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> random;
    for (int n = 0; n < 4000; ++n) {
      const float theta_i = 0.9f * random(engine), u = random(engine), v = random(engine);
      const auto s = packed.sample(theta_i, u, v);
      const auto back = packed.invert(theta_i, s.wo);
      ASSERT_TRUE(back);
      ASSERT_NEAR(back->at.u, u, 1e-4) << parallels << ' ' << theta_i;
      ASSERT_NEAR(back->at.v, v, 1e-4) << parallels << ' ' << theta_i;
      ASSERT_NEAR(back->pdf, s.pdf, 2e-3f * s.pdf + 1e-4f);
      ASSERT_EQ(back->pdf, packed.pdf(theta_i, s.wo));
    }
  }
}

// By the exact integral of what grid() says, and by quadrature of pdf() itself.
TEST_P(Packed, IntegratesToOne) {
  const PackedStack packed(lobe(GetParam(), 5, 12, 20, 0.3));
  for (const DiagramGrid& d : packed.grid().diagrams) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < d.phi.size(); ++i)
      for (std::size_t j = 0; j + 1 < d.r.size(); ++j)
        for (const std::size_t side : {i, i + 1})
          sum += (d.phi[i + 1] - d.phi[i]) / 2 *
                 RadialCell<double>{d.r[j], d.r[j + 1] - d.r[j], d.at(side, j), d.at(side, j + 1)}.mass(1);
    EXPECT_NEAR(2 * sum, 1, 2e-7);
  }
  for (const float theta_i : {0.0f, 0.2f, 0.75f, 1.1f}) {
    double sum = 0;
    constexpr int side = 1000;  // midpoints in phi and r^2
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const Polar<float> p{std::sqrt((static_cast<float>(j) + 0.5f) / side),
                             pi<float> * (2 * (static_cast<float>(i) + 0.5f) / side - 1)};
        sum += packed.pdf(theta_i, polar_to_direction(p));
      }
    EXPECT_NEAR(sum * 2 * pi<double> / side / side, 1, 1e-4) << theta_i;
  }
}

TEST_P(Packed, PackingAgainGivesTheSameBits) {
  const PackedStack packed(lobe(GetParam(), 4, 9, 21, 0.01, 1e-9));
  const StackGrid grid = packed.grid(), again = PackedStack(grid).grid();
  EXPECT_EQ(grid.theta_i, again.theta_i);
  EXPECT_EQ(grid.chart, again.chart);
  for (std::size_t k = 0; k < grid.diagrams.size(); ++k) {
    EXPECT_EQ(grid.diagrams[k].phi, again.diagrams[k].phi);
    EXPECT_EQ(grid.diagrams[k].r, again.diagrams[k].r);
    EXPECT_EQ(grid.diagrams[k].density, again.diagrams[k].density);
  }
  const PackedStack second(grid);
  for (int n = 0; n < 100; ++n) {
    const float x = static_cast<float>(n) / 100;
    EXPECT_EQ(packed.sample(x, x, 1 - x).wo, second.sample(x, x, 1 - x).wo);
  }
}

TEST(PackedStack, BytesOfACrossing) {
  const StackGrid grid = lobe(Chart::half, 32, 40, 40);
  const PackedStack packed(grid);
  EXPECT_LT(static_cast<double>(packed.bytes()) / (32 * 40 * 40), 2.9);
  EXPECT_LT(2.9 * static_cast<double>(packed.bytes()),
            static_cast<double>(Stack<float>(grid, Interpolation::blend).bytes()));
}

TEST(PackedStack, OneDiagramServesEveryAngle) {
  const PackedStack packed(lobe(Chart::outgoing, 1, 8, 8));
  EXPECT_EQ(packed.sample(0, 0.3f, 0.8f).wo, packed.sample(1.2f, 0.3f, 0.8f).wo);
}

TEST(PackedStack, DownwardDirectionsHaveNoDensity) {
  const PackedStack packed(lobe(Chart::outgoing, 3, 8, 8));
  EXPECT_EQ(packed.pdf(0.3f, {0.6f, 0, -0.8f}), 0);
  EXPECT_FALSE(packed.invert(0.3f, {0.6f, 0, -0.8f}));
}

// Whole cells, blocks and meridians without density: no draw falls there.
TEST(PackedStack, ZeroRegions) {
  StackGrid grid = lobe(Chart::outgoing, 3, 8, 40);
  for (DiagramGrid& d : grid.diagrams)
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t j = 0; j < 40; ++j)
        if (i < 2 || j < 10 || (j > 12 && j < 30) || j > 36) d.at(i, j) = 0;
  const PackedStack packed(grid);
  std::mt19937 engine(9);
  std::uniform_real_distribution<float> random;
  for (int n = 0; n < 20000; ++n) {
    const float theta_i = 1.5f * random(engine), u = random(engine), v = random(engine);
    const auto s = packed.sample(theta_i, u, v);
    ASSERT_GT(s.pdf, 0);
    const auto back = packed.invert(theta_i, s.wo);
    ASSERT_TRUE(back);
    if (s.pdf < 1e-3f) continue;
    EXPECT_NEAR(back->at.u, u, 1e-4);
    EXPECT_NEAR(back->at.v, v, 1e-4);
  }
  EXPECT_FALSE(packed.invert(0.5f, {0, 0, 1}));
}

TEST(PackedStack, BadInput) {
  const StackGrid good = lobe(Chart::half, 3, 8, 8);
  const auto message = [](const StackGrid& grid) -> std::string {
    try {
      const PackedStack packed(grid);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message(good), "");
  StackGrid bad = good;
  bad.diagrams[1].r[3] += 0.01;
  EXPECT_NE(message(bad).find("shared lines"), std::string::npos);
  bad = good, bad.theta_i[1] = 3;
  EXPECT_NE(message(bad).find("theta_i[1]"), std::string::npos);
  bad = good, bad.diagrams[2].density[5] = std::nan("");
  EXPECT_NE(message(bad).find("density[5]"), std::string::npos);
  bad = good, bad.diagrams[2].density.assign(64, 0);
  EXPECT_NE(message(bad).find("zero everywhere"), std::string::npos);
  bad = good;
  for (DiagramGrid& d : bad.diagrams) {
    d.azimuth = Azimuth::full;
    d.phi.back() = 2 * pi<double>;
    for (std::size_t j = 0; j < 8; ++j) d.at(7, j) = d.at(0, j);
  }
  EXPECT_NE(message(bad).find("full azimuth"), std::string::npos);
  EXPECT_NE(message({}).find("0 incident angles"), std::string::npos);
}

}  // namespace
}  // namespace gonio
