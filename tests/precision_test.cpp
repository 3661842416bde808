#include <gonio/mapping/diagram.h>
#include <gonio/mapping/hemisphere.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace gonio {
namespace {

constexpr double epsilon = std::numeric_limits<float>::epsilon();

DiagramGrid grid(unsigned seed, double decades) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> random;
  DiagramGrid g;
  const auto lines = [&](double last, int count) {
    std::vector<double> x{0};
    for (int k = 1; k < count; ++k) x.push_back(x.back() + 0.02 + random(engine));
    for (double& v : x) v *= last / x.back();
    x.back() = last;
    return x;
  };
  g.phi = lines(pi<double>, 40);
  g.r = lines(1, 40);
  for (int k = 0; k < 1600; ++k) g.density.push_back(std::pow(10.0, -decades * random(engine)));
  return g;
}

// The bounds that diagram.h states: a float diagram against the same diagram in long double.
void against_long_double(const DiagramGrid& g, double& worst_u, double& worst_v, double& worst_pdf, double& worst_back) {
  const Diagram<float> d(g);
  const Diagram<long double> exact(d.grid());
  const double scale = static_cast<double>(exact.mass());
  double peak = 0;
  for (const double x : d.grid().density) peak = std::max(peak, x);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> random;
  for (int k = 0; k < 200000; ++k) {
    const float u = random(engine), v = random(engine);
    const auto m = d.meridian_at(u);
    const auto p = d.parallel_at(m, v);
    const auto em = exact.meridian_through(m.phi);
    // Forward maps: how much mass really lies below the answer.
    worst_back = std::max(worst_back, std::abs(static_cast<double>(exact.u_of(em) * exact.mass()) / scale - u));
    worst_back = std::max(worst_back, std::abs(static_cast<double>(exact.v_of(em, p.r)) - v) *
                                          std::min(1.0, static_cast<double>(em.mass)));
    // Inverse maps and pdf at a direction that floats hold exactly.
    // (Not beyond the last but one meridian: the last is at pi, as T holds it.)
    const float phi = static_cast<float>(g.phi[g.phi.size() - 2]) * random(engine), r = random(engine);
    const auto a = d.meridian_through(phi);
    const auto b = exact.meridian_through(phi);
    worst_u = std::max(worst_u, std::abs(static_cast<double>(exact.u_of(b) - d.u_of(a))));
    worst_v = std::max(worst_v, std::abs(static_cast<double>(exact.v_of(b, r) - d.v_of(a, r))));
    worst_pdf = std::max(worst_pdf, std::abs(static_cast<double>(exact.pdf(b, r) - d.pdf(a, r))) / peak);
  }
}

TEST(Precision, DiagramInFloat) {
  for (const double decades : {2.0, 12.0}) {
    double u = 0, v = 0, pdf = 0, back = 0;
    for (const unsigned seed : {1u, 2u, 3u}) against_long_double(grid(seed, decades), u, v, pdf, back);
    EXPECT_LE(u, 4 * epsilon) << decades;
    EXPECT_LE(v, 8 * epsilon) << decades;
    EXPECT_LE(pdf, 4 * epsilon) << decades;
    EXPECT_LE(back, (decades > 2 ? 64 : 16) * epsilon) << decades;
  }
}

}  // namespace
}  // namespace gonio
