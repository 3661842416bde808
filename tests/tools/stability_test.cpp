#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>

#include <boost/math/special_functions/gamma.hpp>
#include <gtest/gtest.h>

#include <gonio/brdf/proof/statistics/random.h>
#include <gonio/mapping/diagram/diagram.cpp>  // for Diagram<OperationCounter>
#include <gonio/mapping/numeric/monotone_root.h>

#include "tools/stability/figures.h"
#include "tools/stability/measure_row.h"

namespace gonio {
namespace {

// The inputs that single out each textbook variant; `gonio stability` runs all.
TEST(Stability, TextbookVariantsFailAndTheLibraryDoesNot) {
  const std::set<std::string> chosen{"nearly-constant", "pole-ring", "theta-worst", "rotating"};
  std::map<std::string, int> failures;
  std::uint32_t seed = 1;
  for (const StabilityInput& input : stability_inputs()) {
    if (!chosen.count(input.name)) continue;
    for (const StabilityRow& row : measure_input(input, 56, seed += 1000)) {
      failures[row.variant] += row.fails();
      EXPECT_FALSE(row.library() && row.fails())
          << row.variant << " on " << row.input << ": error " << row.max_error << " of " << row.bound << ", bias "
          << row.bias << " +- " << row.standard_error << ", p " << row.chi2_p << ", lost " << row.lost;
    }
  }
  ASSERT_EQ(failures.size(), variant_names().size());
  for (const auto& [variant, count] : failures) EXPECT_TRUE(count > 0 || variant.rfind("gonio-", 0) == 0) << variant;
}

// Each textbook variant fails in the way that its reason says.
TEST(Stability, HowTheyFail) {
  std::map<std::string, StabilityRow> at;
  for (const StabilityInput& input : stability_inputs())
    if (input.name == "nearly-constant" || input.name == "pole-ring")
      for (const StabilityRow& row : measure_input(input, 28, 5)) at[row.input + " " + row.variant] = row;
  EXPECT_GT(at["nearly-constant cardan"].max_error, 1e5);
  EXPECT_TRUE(at["nearly-constant cardan"].chi2_fails);
  EXPECT_GT(at["nearly-constant quadratic"].max_error, 1e4);
  EXPECT_TRUE(at["pole-ring acos"].chi2_fails);
}

// The numbers of section 3.2 (the paper cuts 3.68 % to 3.6).
TEST(Stability, ErrorOfReadingThetaAsRadius) {
  const WorstReading one = worst_reading_error(1), ten = worst_reading_error(10);
  EXPECT_NEAR(one.absolute, 0.042, 0.0005);
  EXPECT_NEAR(one.relative, 0.215, 0.0005);
  EXPECT_NEAR(one.absolute_at, 0.895, 0.02);  // a flat maximum
  EXPECT_NEAR(one.relative_at, pi<double> / 2, 1e-3);
  EXPECT_NEAR(ten.absolute, 0.009, 0.0005);
  EXPECT_NEAR(ten.relative, 0.0365, 0.0005);
}

// Rejection sampling as the reference (section 5.2), for the diagrams of Fig. 6: two histograms.
double rejection_p(const DiagramGrid& grid, double r_power) {
  const Diagram<float> diagram(grid);
  const double peak = *std::max_element(grid.density.begin(), grid.density.end());
  constexpr int sectors = 24, rings = 20, draws = 300000;
  std::vector<double> ours(sectors * rings), reference(sectors * rings);
  const auto count = [&](std::vector<double>& histogram, double phi, double r) {
    const int i = std::min(static_cast<int>(phi / (2 * pi<double>)*sectors), sectors - 1);
    histogram[static_cast<std::size_t>(i * rings + std::min(static_cast<int>(r * rings), rings - 1))] += 1;
  };
  proof::Random random(17);
  for (int k = 0; k < draws; ++k) {
    const glm::vec2 x = random.pair();
    const Polar<float> at = diagram.sample(x.x, x.y).at;
    count(ours, at.phi, std::pow(at.r, r_power));
  }
  for (int k = 0; k < draws;) {
    const double phi = 2 * pi<double> * random(), r = std::sqrt(random());
    const auto line = [](const std::vector<double>& x, double t) {
      return static_cast<std::size_t>(std::upper_bound(x.begin() + 1, x.end() - 1, t) - x.begin()) - 1;
    };
    const std::size_t i = line(grid.phi, phi), j = line(grid.r, r);
    const double a = (phi - grid.phi[i]) / (grid.phi[i + 1] - grid.phi[i]),
                 s = (r - grid.r[j]) / (grid.r[j + 1] - grid.r[j]);
    const double density = (1 - a) * ((1 - s) * grid.at(i, j) + s * grid.at(i, j + 1)) +
                           a * ((1 - s) * grid.at(i + 1, j) + s * grid.at(i + 1, j + 1));
    if (peak * random() < density) count(reference, phi, r), ++k;
  }
  double statistic = 0;
  int cells = 0;
  for (std::size_t k = 0; k < ours.size(); ++k) {
    const double sum = ours[k] + reference[k];
    if (sum < 10) continue;
    statistic += (ours[k] - reference[k]) * (ours[k] - reference[k]) / sum;
    ++cells;
  }
  return boost::math::gamma_q((cells - 1) / 2.0, statistic / 2);
}

TEST(Stability, RejectionSamplingAgrees) {
  EXPECT_GT(rejection_p(figure_6_grid(false), 1), 0.005);
  EXPECT_GT(rejection_p(figure_6_grid(true), 1), 0.005);
  EXPECT_LT(rejection_p(figure_6_grid(false), 1.05), 1e-6);  // a map that is off is noticed
}

/// A double that counts arithmetic, comparisons and elementary functions.
struct OperationCounter {
  constexpr OperationCounter() = default;
  template <class A, std::enable_if_t<std::is_arithmetic_v<A>, int> = 0>
  constexpr OperationCounter(A x) : value(static_cast<double>(x)) {}
  constexpr operator double() const { return value; }
  double value = 0;
  static int count;
};
int OperationCounter::count = 0;

template <class A, class B>
using IfCounted = std::enable_if_t<std::is_same_v<A, OperationCounter> || std::is_same_v<B, OperationCounter>, int>;
#define GONIO_COUNT(op, Result)                              \
  template <class A, class B, IfCounted<A, B> = 0>           \
  Result operator op(const A& a, const B& b) {               \
    ++OperationCounter::count;                               \
    return static_cast<double>(a) op static_cast<double>(b); \
  }
GONIO_COUNT(+, OperationCounter)
GONIO_COUNT(-, OperationCounter)
GONIO_COUNT(*, OperationCounter)
GONIO_COUNT(/, OperationCounter)
GONIO_COUNT(<, bool)
GONIO_COUNT(>, bool)
GONIO_COUNT(>=, bool)
#undef GONIO_COUNT
#define GONIO_COUNT(function)                     \
  OperationCounter function(OperationCounter x) { \
    ++OperationCounter::count;                    \
    return std::function(x.value);                \
  }
GONIO_COUNT(sqrt)
GONIO_COUNT(cbrt)
GONIO_COUNT(cos)
GONIO_COUNT(acos)
#undef GONIO_COUNT

struct Range {
  int least = 1 << 30, most = 0;
  void add(int n) { least = std::min(least, n), most = std::max(most, n); }
};

// "A constant number of arithmetic operations" (section 2): the searches take the same steps for any
// data, and the root formulas have one branch each, of nearly the same length.
TEST(Stability, OperationsDoNotDependOnTheData) {
  using Counted = OperationCounter;
  Range all;
  proof::Random random(3);
  for (int kind = 0; kind < 4; ++kind) {  // constant, noise, twelve decades, a spike
    DiagramGrid grid;
    for (int i = 0; i < 17; ++i) grid.phi.push_back(pi<double> * i / 16);
    for (int j = 0; j < 17; ++j) grid.r.push_back(j / 16.0);
    for (int k = 0; k < 17 * 17; ++k)
      grid.density.push_back(kind == 0   ? 1
                             : kind == 1 ? 0.1 + random()
                             : kind == 2 ? std::pow(10, -12 * random())
                             : k == 100  ? 1e4
                                         : 1);
    const Diagram<Counted> diagram(grid);
    for (int k = 0; k < 5000; ++k) {
      const double u = random(), v = random();
      Counted::count = 0;
      diagram.sample(Counted(u), Counted(v));
      all.add(Counted::count);
    }
  }
  EXPECT_GT(all.least, 100);
  EXPECT_LE(all.most - all.least, 6) << all.least << " to " << all.most;

  // The count sees a method that iterates: inverting the same masses by a root search.
  Range iterated;
  for (int k = 0; k < 1000; ++k) {
    const RadialCell<Counted> cell{0.1, 0.2, random(), random()};
    const double tau = random();
    Counted::count = 0;
    double lo = 0, hi = 1;
    while (hi - lo > 1e-12 && std::abs(double(cell.mass((lo + hi) / 2)) / double(cell.mass(1.0)) - tau) > 1e-6)
      (double(cell.mass((lo + hi) / 2)) / double(cell.mass(1.0)) > tau ? hi : lo) = (lo + hi) / 2;
    iterated.add(Counted::count);
  }
  EXPECT_GT(iterated.most - iterated.least, 100);
}

// Section 5.1: 2 M N + 3 M + 2 values; here 2 M N + 2 M + N, never more for N <= M + 2.
TEST(Stability, MemoryFormula) {
  for (const auto& [m, n] : {std::pair{7, 6}, {11, 8}, {33, 33}}) {
    DiagramGrid grid;
    for (int i = 0; i < m; ++i) grid.phi.push_back(pi<double> * i / (m - 1));
    for (int j = 0; j < n; ++j) grid.r.push_back(static_cast<double>(j) / (n - 1));
    grid.density.assign(grid.phi.size() * grid.r.size(), 1.0);
    const Diagram<float> diagram(grid);
    EXPECT_EQ(diagram.bytes() - sizeof(diagram), static_cast<std::size_t>(2 * m * n + 2 * m + n) * sizeof(float));
    EXPECT_LE(diagram.bytes() - sizeof(diagram), static_cast<std::size_t>(2 * m * n + 3 * m + 2) * sizeof(float));
  }
}

}  // namespace
}  // namespace gonio
