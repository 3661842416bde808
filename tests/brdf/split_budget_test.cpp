#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/brdf/build/budget/split_budget.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

using Curves = std::vector<std::vector<BudgetPoint>>;

std::size_t bytes_of(const Curves& curves, const std::vector<std::size_t>& chosen) {
  std::size_t sum = 0;
  for (std::size_t k = 0; k < curves.size(); ++k) sum += curves[k][chosen[k]].bytes;
  return sum;
}

double variance_of(const Curves& curves, const std::vector<double>& weights, const std::vector<std::size_t>& chosen) {
  double sum = 0;
  for (std::size_t k = 0; k < curves.size(); ++k) sum += weights[k] * curves[k][chosen[k]].variance;
  return sum;
}

/// The least sum of all combinations that fit.
double least(const Curves& curves, const std::vector<double>& weights, std::size_t bytes, std::size_t k = 0) {
  if (k == curves.size()) return 0;
  double best = std::numeric_limits<double>::infinity();
  for (const BudgetPoint& p : curves[k]) {
    if (p.bytes <= bytes)
      best = std::min(best, weights[k] * p.variance + least(curves, weights, bytes - p.bytes, k + 1));
  }
  return best;
}

bool by_bytes(const BudgetPoint& a, const BudgetPoint& b) { return a.bytes < b.bytes; }

struct Case {
  Curves curves;
  std::vector<double> weights;
  std::size_t smallest = 0, largest = 0;
};

/// Curves that fall as sizes grow, convex or with noise on every point.
Case random_case(std::mt19937& random, std::size_t materials, std::size_t points, double noise) {
  std::uniform_real_distribution<double> uniform;
  Case c;
  for (std::size_t k = 0; k < materials; ++k) {
    std::vector<BudgetPoint> curve;
    const double scale = std::pow(10, -2 * uniform(random));
    for (std::size_t p = 0; p < points; ++p) {
      const std::size_t bytes = (p + 1) * (p + 1) * (5 + random() % 5) + 20 * k;
      curve.push_back({bytes, scale / static_cast<double>(bytes) * (1 + noise * uniform(random))});
    }
    std::sort(curve.begin(), curve.end(), by_bytes);
    c.smallest += curve.front().bytes;
    c.largest += curve.back().bytes;
    std::shuffle(curve.begin(), curve.end(), random);
    c.curves.push_back(curve);
    c.weights.push_back(uniform(random));
  }
  return c;
}

/// The largest gain of a step from one point of a lower convex hull to the next.
double largest_hull_step(const Case& c) {
  double largest = 0;
  for (std::size_t k = 0; k < c.curves.size(); ++k) {
    auto curve = c.curves[k];
    std::sort(curve.begin(), curve.end(), by_bytes);
    for (std::size_t p = 0; p + 1 < curve.size();) {
      std::size_t to = p;
      double steepest = 0;
      for (std::size_t q = p + 1; q < curve.size(); ++q) {
        const double slope =
            (curve[p].variance - curve[q].variance) / static_cast<double>(curve[q].bytes - curve[p].bytes);
        if (slope > steepest) steepest = slope, to = q;
      }
      if (to == p) break;
      largest = std::max(largest, c.weights[k] * (curve[p].variance - curve[to].variance));
      p = to;
    }
  }
  return largest;
}

TEST(SplitBudget, IsWithinAStepOfTheBestOfAll) {
  std::mt19937 random(3);
  double excess = 0;
  int cases = 0, exact = 0;
  for (int n = 0; n < 300; ++n) {
    const Case c = random_case(random, 5, 6, n % 2 == 0 ? 0 : 1.5);
    const std::size_t bytes = c.smallest + random() % (c.largest - c.smallest + 1);
    const auto chosen = split_budget(c.curves, c.weights, bytes);
    EXPECT_LE(bytes_of(c.curves, chosen), bytes);
    const double found = variance_of(c.curves, c.weights, chosen), best = least(c.curves, c.weights, bytes);
    EXPECT_GE(found, best * (1 - 1e-12));
    EXPECT_LE(found, best + largest_hull_step(c));
    excess += found / best - 1;
    exact += found <= best * (1 + 1e-12);
    ++cases;
  }
  EXPECT_LT(excess / cases, 0.05);
  EXPECT_GT(exact, cases / 3);
}

// Where a budget is spent to the last byte on the hull, nothing that takes no more is better.
TEST(SplitBudget, IsOptimalWhereEverythingFits) {
  std::mt19937 random(5);
  for (int n = 0; n < 100; ++n) {
    const Case c = random_case(random, 4, 5, 0);
    // With all that the largest take, every curve ends at its least variance.
    const auto all = split_budget(c.curves, c.weights, c.largest);
    EXPECT_DOUBLE_EQ(variance_of(c.curves, c.weights, all), least(c.curves, c.weights, c.largest));
    // The first step alone, which is the steepest: exactly its bytes.
    for (std::size_t extra = 1; extra < c.largest - c.smallest; ++extra) {
      const auto chosen = split_budget(c.curves, c.weights, c.smallest + extra);
      if (bytes_of(c.curves, chosen) != c.smallest + extra) continue;
      EXPECT_NEAR(variance_of(c.curves, c.weights, chosen), least(c.curves, c.weights, c.smallest + extra), 1e-12);
      break;
    }
  }
}

TEST(SplitBudget, BeatsAnEvenSplitOfUnevenMaterials) {
  // Twenty like materials, four of which are most of the picture.
  Case c;
  for (int k = 0; k < 20; ++k) {
    std::vector<BudgetPoint> curve;
    for (std::size_t bytes = 100; bytes <= 102400; bytes = bytes * 5 / 4)
      curve.push_back({bytes, 1 / static_cast<double>(bytes)});
    c.curves.push_back(curve);
    c.weights.push_back(k < 4 ? 0.2 : 0.0125);
  }
  const std::size_t bytes = 20 * 2000;
  const auto chosen = split_budget(c.curves, c.weights, bytes);
  EXPECT_LE(bytes_of(c.curves, chosen), bytes);
  // The optimum of v = 1/b over real numbers is bytes in proportion to sqrt(weight); even: 1/2000.
  const double roots = 4 * std::sqrt(0.2) + 16 * std::sqrt(0.0125),
               optimum = roots * roots / static_cast<double>(bytes);
  const double found = variance_of(c.curves, c.weights, chosen);
  EXPECT_LT(found, 1.05 * optimum);
  EXPECT_LT(found, 0.68 / 2000);
  // With equal weights there is nothing to gain.
  c.weights.assign(20, 0.05);
  EXPECT_GT(variance_of(c.curves, c.weights, split_budget(c.curves, c.weights, bytes)), 0.95 / 2000);
}

TEST(SplitBudget, SpendsNothingInVain) {
  // The second never appears; the first does not improve beyond 20 bytes, and 15 is worse than 10.
  const Curves curves{{{10, 1.0}, {15, 2.0}, {20, 0.5}, {40, 0.5}}, {{10, 9.0}, {20, 0.0}}};
  EXPECT_EQ(split_budget(curves, {1, 0}, 1000), (std::vector<std::size_t>{2, 0}));
  EXPECT_EQ(split_budget({}, {}, 0), std::vector<std::size_t>{});
  // Equally small: the better one.
  EXPECT_EQ(split_budget({{{10, 2.0}, {10, 1.0}}}, {1}, 10), std::vector<std::size_t>{1});
}

TEST(SplitBudget, FillsUpWithWhatStillFits) {
  // The best step, 100 bytes of the first, does not fit; the small one of the second does.
  EXPECT_EQ(split_budget({{{10, 100.0}, {110, 0.0}}, {{10, 1.0}, {20, 0.5}}}, {1, 1}, 50),
            (std::vector<std::size_t>{0, 1}));
  // Nor does the hull's next point; one above the hull does.
  EXPECT_EQ(split_budget({{{10, 100.0}, {50, 90.0}, {110, 0.0}}}, {1}, 60), std::vector<std::size_t>{1});
}

void expect_error(const Curves& curves, const std::vector<double>& weights, std::size_t bytes, const char* part) {
  try {
    split_budget(curves, weights, bytes);
    FAIL() << part;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(part));
  }
}

TEST(SplitBudget, SaysWhatIsWrong) {
  const std::vector<BudgetPoint> good{{10, 1.0}};
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error({good, {{30, 1.0}, {20, 2.0}}}, {1, 1}, 29, "found 29 bytes, expected at least 30");
  expect_error({good, {}}, {1, 1}, 100, "curve 1: found no points");
  expect_error({good}, {1, 1}, 100, "weights: found 2, expected 1");
  expect_error({good}, {-1}, 100, "weight 0");
  expect_error({good}, {nan}, 100, "weight 0");
  expect_error({{{10, nan}}}, {1}, 100, "curve 0: variance");
  expect_error({{{10, -1.0}}}, {1}, 100, "curve 0: variance");
}

}  // namespace
}  // namespace gonio
