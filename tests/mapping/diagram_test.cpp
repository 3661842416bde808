#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/diagram/diagram.h>

namespace gonio {
namespace {

DiagramGrid random_grid(Azimuth azimuth, std::size_t m, std::size_t n, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> random;
  const auto lines = [&](double last, std::size_t count) {
    std::vector<double> x{0};
    for (std::size_t k = 1; k < count; ++k) x.push_back(x.back() + 0.05 + random(engine));
    for (double& v : x) v *= last / x.back();
    x.back() = last;
    return x;
  };
  DiagramGrid grid;
  grid.azimuth = azimuth;
  grid.phi = lines(azimuth == Azimuth::half ? pi<double> : 2 * pi<double>, m);
  grid.r = lines(1, n);
  grid.density.resize(m * n);
  for (double& d : grid.density) d = std::pow(10.0, -3 * random(engine));
  if (azimuth == Azimuth::full)
    for (std::size_t j = 0; j < n; ++j) grid.at(m - 1, j) = grid.at(0, j);
  return grid;
}

template <class T>
void round_trip(const DiagramGrid& grid, double bound) {
  const Diagram<T> d(grid);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> random;
  for (int k = 0; k < 20000; ++k) {
    const T u = static_cast<T>(random(engine)), v = static_cast<T>(random(engine));
    const auto s = d.sample(u, v);
    const auto back = d.invert(s.at);
    ASSERT_NEAR(static_cast<double>(back.u), static_cast<double>(u), bound);
    ASSERT_NEAR(static_cast<double>(back.v), static_cast<double>(v), bound);
    ASSERT_NEAR(static_cast<double>(back.pdf / s.pdf), 1, 50 * bound);
    ASSERT_EQ(d.pdf(s.at), back.pdf);
  }
}

TEST(Diagram, RoundTrip) {
  for (const Azimuth azimuth : {Azimuth::half, Azimuth::full}) {
    const DiagramGrid grid = random_grid(azimuth, 7, 6, 2);
    round_trip<float>(grid, 3e-6);
    round_trip<double>(grid, 1e-14);
    round_trip<long double>(grid, 1e-14);
  }
}

// The area of the image of a small (u, v) cell times the pdf is the area of the cell: the map has the
// density that pdf() says, by differences alone.
TEST(Diagram, PdfIsTheJacobian) {
  const Diagram<double> d(random_grid(Azimuth::full, 5, 4, 9));
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> random;
  constexpr double h = 1e-6;
  for (int k = 0; k < 2000; ++k) {
    const double u = h + (1 - 2 * h) * random(engine), v = h + (1 - 2 * h) * random(engine);
    const auto a = meridian_at_mass(d, u - h), b = meridian_at_mass(d, u + h);
    if (a.i != b.i) continue;
    const double r0 = d.sample(u, v - h).at.r, r1 = d.sample(u, v + h).at.r;
    const double area = (b.phi - a.phi) * (r1 * r1 - r0 * r0);
    ASSERT_NEAR(d.sample(u, v).pdf * area / (4 * h * h), 1, 2e-3);
  }
}

TEST(Diagram, ConstantDensityIsTheIdentity) {
  DiagramGrid grid;
  grid.phi = {0, 1, pi<double>};
  grid.r = {0, 0.2, 0.21, 1};
  grid.density.assign(12, 7.0);
  const Diagram<double> d(grid);
  const auto s = d.sample(0.3, 0.49);
  EXPECT_NEAR(s.at.phi, 0.3 * pi<double>, 1e-15);
  EXPECT_NEAR(s.at.r, 0.7, 1e-15);
  EXPECT_NEAR(s.pdf, 1 / (2 * pi<double>), 1e-15);
}

TEST(Diagram, MassAndPdfIntegral) {
  for (const Azimuth azimuth : {Azimuth::half, Azimuth::full}) {
    const Diagram<float> d(random_grid(azimuth, 9, 8, 4));
    EXPECT_NEAR(d.mass(), azimuth == Azimuth::half ? 0.5 : 1, 1e-6);
    double sum = 0;
    constexpr int side = 1000;
    const double range = azimuth == Azimuth::half ? pi<double> : 2 * pi<double>;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        sum += d.pdf({static_cast<float>((j + 0.5) / side), static_cast<float>((i + 0.5) / side * range)}) * 2 *
               (j + 0.5) / side / side * range / side;
    EXPECT_NEAR(sum, d.mass(), 1e-4);
  }
}

// Zero regions: no draw lands where the density is zero, nothing is NaN, u and v may be 0 and 1.
TEST(Diagram, ZeroRegions) {
  DiagramGrid grid = random_grid(Azimuth::half, 6, 5, 3);
  for (std::size_t i = 0; i < 6; ++i) grid.at(i, 4) = 0;                  // the horizon
  for (std::size_t i = 1; i < 3; ++i) grid.at(i, 1) = grid.at(i, 2) = 0;  // a patch (Fig. 6d)
  for (std::size_t j = 0; j < 5; ++j) grid.at(4, j) = 0;                  // a meridian
  const Diagram<float> d(grid);
  for (const float u : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.77f, 1 - 0x1p-24f, 1.0f})
    for (const float v : {0.0f, 0x1p-24f, 0.3f, 0.5f, 0.9f, 1 - 0x1p-24f, 1.0f}) {
      const auto s = d.sample(u, v);
      ASSERT_TRUE(std::isfinite(s.at.phi) && std::isfinite(s.at.r) && std::isfinite(s.pdf)) << u << ' ' << v;
      ASSERT_GE(s.at.r, 0);
      ASSERT_LE(s.at.r, 1);
    }
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> random;
  for (int k = 0; k < 100000; ++k) {
    const float u = random(engine);
    const Polar<float> at = d.sample(u, random(engine)).at;
    const bool inside = at.phi > grid.phi[1] && at.phi < grid.phi[2] && at.r > grid.r[1] && at.r < grid.r[2];
    ASSERT_FALSE(inside) << "a draw in the patch without density";
  }
}

TEST(Diagram, TwelveDecades) {
  DiagramGrid grid = random_grid(Azimuth::half, 8, 8, 6);
  for (std::size_t k = 0; k < grid.density.size(); ++k)
    grid.density[k] = std::pow(10.0, -12.0 * static_cast<double>(k % 7) / 6);
  round_trip<double>(grid, 1e-13);
  const Diagram<float> d(grid);
  for (int k = 0; k <= 1000; ++k) ASSERT_TRUE(std::isfinite(d.sample(static_cast<float>(k) / 1000, 0.5f).at.r));
}

TEST(Diagram, TwoLinesAreEnough) {
  DiagramGrid grid;
  grid.phi = {0, pi<double>};
  grid.r = {0, 1};
  grid.density = {1, 0, 3, 2};
  round_trip<double>(grid, 1e-14);
}

TEST(Diagram, RebuildsBitByBit) {
  const Diagram<float> a(random_grid(Azimuth::half, 12, 10, 8)), b(a.grid());
  const DiagramGrid ga = a.grid(), gb = b.grid();
  EXPECT_EQ(ga.density, gb.density);
  EXPECT_EQ(ga.phi, gb.phi);
  EXPECT_EQ(ga.r, gb.r);
}

TEST(Diagram, MemoryOfThePaper) {  // 2MN + 3M + 2 for one diagram, section 5.1
  const Diagram<float> d(random_grid(Azimuth::half, 11, 8, 1));
  EXPECT_LE(d.bytes() - sizeof(d), (2 * 11 * 8 + 3 * 11 + 2) * sizeof(float));
}

TEST(Diagram, RefusesBadInputByName) {
  const auto message = [](const DiagramGrid& grid) -> std::string {
    try {
      Diagram<float> d(grid);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  const DiagramGrid good = random_grid(Azimuth::half, 4, 4, 1);
  EXPECT_EQ(message(good), "");
  DiagramGrid g = good;
  g.phi[2] = g.phi[1];
  EXPECT_NE(message(g).find("meridians[2]"), std::string::npos);
  g = good;
  g.r.back() = 0.9;
  EXPECT_NE(message(g).find("parallels"), std::string::npos);
  g = good;
  g.density[5] = -1;
  EXPECT_NE(message(g).find("density[5]"), std::string::npos);
  g = good;
  g.density[3] = std::nan("");
  EXPECT_NE(message(g).find("density[3]"), std::string::npos);
  g = good;
  g.density.pop_back();
  EXPECT_NE(message(g).find("15 values, expected 16"), std::string::npos);
  g = good;
  std::fill(g.density.begin(), g.density.end(), 0.0);
  EXPECT_NE(message(g).find("zero everywhere"), std::string::npos);
  g = random_grid(Azimuth::full, 4, 4, 1);
  g.at(3, 2) += 1;
  EXPECT_NE(message(g).find("parallel 2"), std::string::npos);
}

}  // namespace
}  // namespace gonio
