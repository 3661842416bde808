#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/numeric/monotone_root.h>
#include <gonio/mapping/stack/stack.h>

namespace gonio {
namespace {

// A lobe that moves with theta_i over a floor, on lines that differ between the diagrams.
StackGrid lobes(Azimuth azimuth = Azimuth::half) {
  StackGrid stack;
  for (int k = 0; k < 4; ++k) {
    const double theta = 0.2 + 0.35 * k;
    DiagramGrid grid;
    grid.azimuth = azimuth;
    const double range = azimuth == Azimuth::half ? pi<double> : 2 * pi<double>;
    const int m = 13 + 2 * k, n = 20 + k;
    for (int i = 0; i < m; ++i) grid.phi.push_back(range * i / (m - 1));
    for (int j = 0; j < n; ++j) grid.r.push_back(static_cast<double>(j) / (n - 1));
    for (const double phi : grid.phi)
      for (const double r : grid.r) {
        const double dx = r * std::cos(phi) + theta_to_radius(theta), dy = r * std::sin(phi);
        grid.density.push_back(std::exp(-(dx * dx + dy * dy) / 0.02) + 0.05 * (1 - r * r) + 1e-6);
      }
    if (azimuth == Azimuth::full)
      for (int j = 0; j < n; ++j) grid.at(m - 1, j) = grid.at(0, j);
    stack.theta_i.push_back(theta);
    stack.diagrams.push_back(std::move(grid));
  }
  return stack;
}

const double angles[] = {0.0, 0.2, 0.21, 0.375, 0.549, 0.55, 0.7, 1.1, 1.25, 1.5};

template <class T>
void round_trip(Interpolation interpolation, Azimuth azimuth, double bound, double pdf_bound) {
  const Stack<T> stack(lobes(azimuth), interpolation);
  const double floor = std::is_same_v<T, float> ? 1e-5 : 0;  // 1e-6 of the largest density, next to the horizon
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> random;
  for (const double angle : angles) {
    const T theta_i = static_cast<T>(angle);
    for (int k = 0; k < 3000; ++k) {
      const T u = static_cast<T>(random(engine)), v = static_cast<T>(random(engine));
      const auto s = stack.sample(theta_i, u, v);
      ASSERT_GT(s.pdf, 0);
      ASSERT_GT(s.wo.z, 0);
      ASSERT_NEAR(static_cast<double>(s.wo.x * s.wo.x + s.wo.y * s.wo.y + s.wo.z * s.wo.z), 1, 1e-6);
      const auto near_pdf = [&](T pdf) {
        return std::abs(static_cast<double>(pdf - s.pdf)) <= pdf_bound * static_cast<double>(s.pdf) + floor;
      };
      ASSERT_TRUE(near_pdf(stack.pdf(theta_i, s.wo)))
          << to_string(interpolation) << " at " << angle << ' ' << u << ' ' << v;
      const auto back = stack.invert(theta_i, s.wo);
      ASSERT_TRUE(back);
      ASSERT_TRUE(near_pdf(back->pdf)) << to_string(interpolation) << " at " << angle << ' ' << u << ' ' << v;
      const auto again = stack.sample(theta_i, back->at.u, back->at.v);  // holds for mixtures, too
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(static_cast<double>(again.wo[c] - s.wo[c]), 0, bound);
      if (interpolation != Interpolation::mixture) {
        ASSERT_NEAR(static_cast<double>(back->at.u - u), 0, bound) << angle << ' ' << u << ' ' << v;
        ASSERT_NEAR(static_cast<double>(back->at.v - v), 0, bound) << angle << ' ' << u << ' ' << v;
      }
    }
  }
}

TEST(Stack, RoundTrip) {
  for (const auto interpolation : {Interpolation::nearest, Interpolation::mixture, Interpolation::displacement}) {
    round_trip<float>(interpolation, Azimuth::half, 1e-4, 2e-3);
    round_trip<double>(interpolation, Azimuth::half, 1e-12, 1e-9);
    round_trip<double>(interpolation, Azimuth::full, 1e-12, 1e-9);
  }
}

// The mass by quadrature of pdf() alone.
TEST(Stack, PdfIntegratesToOne) {
  for (const auto interpolation : {Interpolation::nearest, Interpolation::mixture, Interpolation::displacement}) {
    const Stack<double> stack(lobes(), interpolation);
    for (const double theta_i : {0.0, 0.2, 0.375, 0.7, 1.4}) {
      double sum = 0;
      constexpr int side = 240;
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
          const Polar<double> p{(j + 0.5) / side, pi<double> * (2 * (i + 0.5) / side - 1)};
          sum += stack.pdf(theta_i, polar_to_direction(p)) * 2 * p.r / side * 2 * pi<double> / side;
        }
      EXPECT_NEAR(sum, 1, 1e-3) << to_string(interpolation) << " at " << theta_i;
    }
  }
}

// The pdf is the inverse Jacobian of the sampled map, by differences of directions alone: nothing of
// the closed form is used.
TEST(Stack, DisplacementPdfIsTheJacobian) {
  const Stack<long double> stack(lobes(), Interpolation::displacement);
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> random;
  constexpr long double h = 1e-6L;
  int checked = 0;
  for (int k = 0; k < 4000; ++k) {
    const long double theta_i = 0.2 + 1.05 * random(engine);
    const long double u = h + (1 - 2 * h) * random(engine), v = h + (1 - 2 * h) * random(engine);
    const auto du0 = stack.sample(theta_i, u - h, v).wo, du1 = stack.sample(theta_i, u + h, v).wo;
    const auto dv0 = stack.sample(theta_i, u, v - h).wo, dv1 = stack.sample(theta_i, u, v + h).wo;
    const auto s = stack.sample(theta_i, u, v);
    const auto a = (du1 - du0) / (2 * h), b = (dv1 - dv0) / (2 * h);
    const auto cross = Vec3<long double>(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    const long double area = std::sqrt(cross.x * cross.x + cross.y * cross.y + cross.z * cross.z);
    if (std::abs(s.pdf * area - 1) < 1e-3L) ++checked;  // cells of the diagrams bend the map within h
  }
  EXPECT_GT(checked, 3900);
}

TEST(Stack, MirrorSymmetric) {
  const Stack<float> stack(lobes(), Interpolation::displacement);
  for (const float v : {0.1f, 0.3f, 0.45f}) {
    const auto a = stack.sample(0.6f, 0.3f, v), b = stack.sample(0.6f, 0.3f, 1 - v);
    EXPECT_NEAR(a.wo.x, b.wo.x, 2e-6);
    EXPECT_NEAR(a.wo.y, -b.wo.y, 2e-6);
    EXPECT_NEAR(a.pdf, b.pdf, 1e-4 * a.pdf);
  }
}

// Continuous in theta_i across a diagram, and constant beyond the ends.
TEST(Stack, ContinuousInTheta) {
  const Stack<double> stack(lobes(), Interpolation::displacement);
  for (const double u : {0.1, 0.6})
    for (const double v : {0.2, 0.9})
      for (const double theta : {0.2, 0.55, 0.9, 1.25}) {
        const auto at = stack.sample(theta, u, v), below = stack.sample(theta - 1e-9, u, v),
                   above = stack.sample(theta + 1e-9, u, v);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(at.wo[c], below.wo[c], 1e-7);
          EXPECT_NEAR(at.wo[c], above.wo[c], 1e-7);
        }
        EXPECT_NEAR(below.pdf / at.pdf, 1, 1e-6);
        EXPECT_NEAR(above.pdf / at.pdf, 1, 1e-6);
      }
  EXPECT_EQ(stack.sample(1.57, 0.3, 0.3).wo.x, stack.sample(1.25, 0.3, 0.3).wo.x);
}

// The lobe moves: half way between two diagrams the density peaks half way, where a mixture has a dip.
TEST(Stack, DisplacementMovesTheLobe) {
  const StackGrid grid = lobes();
  const Stack<double> moved(grid, Interpolation::displacement), mixed(grid, Interpolation::mixture);
  const double half_way = 0.375, r = (theta_to_radius(0.2) + theta_to_radius(0.55)) / 2;
  const Vec3<double> middle = polar_to_direction(Polar<double>{r, pi<double> - 1e-9});
  EXPECT_GT(moved.pdf(half_way, middle), 1.4 * mixed.pdf(half_way, middle));
}

TEST(Stack, ExtremesOfTheSquareAndTheHemisphere) {
  for (const auto interpolation : {Interpolation::nearest, Interpolation::mixture, Interpolation::displacement}) {
    const Stack<float> stack(lobes(), interpolation);
    for (const float theta_i : {0.0f, 0.2f, 0.4f, pi<float> / 2, 2.0f})
      for (const float u : {0.0f, 0.5f, 1 - 0x1p-24f, 1.0f})
        for (const float v : {0.0f, 0.5f, 1 - 0x1p-24f, 1.0f}) {
          const auto s = stack.sample(theta_i, u, v);
          ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0);
          ASSERT_GT(s.wo.z, 0);
        }
    EXPECT_EQ(stack.pdf(0.4f, {0, 0, -1}), 0);
    EXPECT_FALSE(stack.invert(0.4f, {0.6f, 0, -0.8f}));
    EXPECT_GT(stack.pdf(0.4f, {0, 0, 1}), 0);
    EXPECT_GE(stack.pdf(0.4f, {1, 0, 0}), 0);
  }
}

// One diagram has a patch without density where its neighbour has some: what displacement cannot
// reach has pdf 0 and no inverse; the rest keeps its mass.
TEST(Stack, GapOfAZeroPatch) {
  StackGrid grid = lobes();
  grid.theta_i.resize(2);
  grid.diagrams.resize(2);
  DiagramGrid& d = grid.diagrams[0];
  for (std::size_t i = 0; i < d.phi.size(); ++i)
    for (std::size_t j = 6; j < 12; ++j) d.at(i, j) = 0;
  const Stack<float> stack(grid, Interpolation::displacement);
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> random;
  int gaps = 0;
  for (int k = 0; k < 20000; ++k) {
    const auto s = stack.sample(0.375f, random(engine), random(engine));
    ASSERT_GT(s.pdf, 0);
    const Vec3<float> any = polar_to_direction(Polar<float>{random(engine), pi<float> * random(engine)});
    gaps += !stack.invert(0.375f, any);
  }
  EXPECT_GT(gaps, 0);
}

TEST(Stack, RebuildsBitByBitAndCountsItsMemory) {
  const Stack<float> a(lobes(), Interpolation::displacement), b(a.grid(), Interpolation::displacement);
  EXPECT_EQ(a.theta_i(), b.theta_i());
  std::size_t floats = a.theta_i().size();
  for (std::size_t k = 0; k < a.diagrams().size(); ++k) {
    EXPECT_EQ(a.diagrams()[k].grid().density, b.diagrams()[k].grid().density);
    const std::size_t m = static_cast<std::size_t>(a.diagrams()[k].meridians()),
                      n = static_cast<std::size_t>(a.diagrams()[k].parallels());
    floats += 2 * m * n + 2 * m + n;
  }
  EXPECT_GE(a.bytes(), floats * sizeof(float));
  EXPECT_LE(a.bytes(), floats * sizeof(float) + 1024);
}

TEST(Stack, RefusesBadInput) {
  StackGrid grid = lobes();
  grid.theta_i[1] = 0.1;
  EXPECT_THROW(Stack<float>(grid, Interpolation::nearest), Error);
  grid = lobes();
  grid.theta_i.pop_back();
  EXPECT_THROW(Stack<float>(grid, Interpolation::nearest), Error);
  grid = lobes();
  grid.diagrams[2] = lobes(Azimuth::full).diagrams[2];
  EXPECT_THROW(Stack<float>(grid, Interpolation::nearest), Error);
  EXPECT_THROW(Stack<float>(StackGrid{}, Interpolation::nearest), Error);
}

// Also where the function jumps, is flat or has a root of high order: the step rule alone must end the search.
TEST(MonotoneRoot, FewSteps) {
  const auto check = [](const auto& f, float root, float bound) {
    for (const float start : {0.0f, 0.1f, 0.5f, 1.0f}) {
      int steps = 0;
      const float x = monotone_root([&](float at) { return ++steps, f(at); }, start, 0.0f, 1.0f);
      EXPECT_NEAR(x, root, bound);
      EXPECT_LE(steps, 64) << root << " from " << start;
    }
  };
  for (const float root : {1e-4f, 0.3f, 0.9999f}) {
    check([&](float x) { return Slope<float>{x - root, 1}; }, root, 1e-6f);
    check([&](float x) { return Slope<float>{x < root ? -1.0f : 1.0f, 0}; }, root, 1e-6f);
    check([&](float x) { return Slope<float>{std::cbrt(x - root), std::pow(x - root, -2.0f / 3) / 3}; }, root, 1e-6f);
    check([&](float x) { return Slope<float>{std::pow(x - root, 5.0f), 5 * std::pow(x - root, 4.0f)}; }, root, 1e-2f);
    check(
        [&](float x) {
          return Slope<float>{x < root ? 1e-3f * (x - root) : 1e3f * (x - root), x < root ? 1e-3f : 1e3f};
        },
        root, 1e-6f);
  }
}

}  // namespace
}  // namespace gonio
