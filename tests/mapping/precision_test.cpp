#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <gonio/mapping/charts/hemisphere.h>
#include <gonio/mapping/diagram/diagram.h>

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

/// The largest errors met, in epsilons of float.
struct Worst {
  double u = 0, v = 0, pdf = 0, pdf_relative = 0, phi_mass = 0, r_mass = 0;
};

/// How far x is outside [low, high].
double outside(double x, double low, double high) { return std::max({low - x, x - high, 0.0}); }

/// Where a function that is linear between `lines` is largest and least within 4 epsilon of x.
std::vector<long double> within_4_epsilon(float x, const std::vector<double>& lines) {
  std::vector<long double> places{x - 4 * epsilon, x, x + 4 * epsilon};
  for (const double line : lines)
    if (std::abs(static_cast<float>(line) - x) < 4 * epsilon) places.push_back(static_cast<float>(line));
  return places;
}

// The bounds that diagram.h states: a float diagram against the same diagram in long double.
void against_long_double(const DiagramGrid& g, Worst& worst) {
  const Diagram<float> d(g);
  const Diagram<long double> exact(d.grid());
  const auto see = [](double& largest, double error) { largest = std::max(largest, error / epsilon); };
  double peak = 0;
  for (const double x : d.grid().density) peak = std::max(peak, x);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> random;
  const auto below = [](float x) { return std::nextafter(x, -1.0f); };
  const auto above = [](float x) { return std::nextafter(x, 9.0f); };
  for (int k = 0; k < 50000; ++k) {
    const float u = random(engine), v = random(engine);
    const Polar<float> s = d.sample(u, v).at;
    const auto v_of = [&](long double phi, float r) { return static_cast<double>(exact.invert({r, phi}).v); };
    // Forward maps: the mass below the values next to the answer encloses what was asked for.
    const auto u_below = [&](float phi) { return static_cast<double>(exact.invert({0, phi}).u); };
    see(worst.phi_mass, outside(u, u_below(below(s.phi)), u_below(above(s.phi))));
    double low = 1, high = 0, mass = 1;
    for (const float at : {below(s.phi), s.phi, above(s.phi)}) {
      low = std::min(low, v_of(at, below(s.r)));
      high = std::max(high, v_of(at, above(s.r)));
      mass = std::min(mass, static_cast<double>(meridian_at_angle<long double>(exact, at).mass));
    }
    see(worst.r_mass, outside(v, low, high) * mass);
    // Inverse maps and pdf at a direction that floats hold exactly.
    // (Not beyond the last but one meridian: the last is at pi, as T holds it.)
    const float phi = static_cast<float>(g.phi[g.phi.size() - 2]) * random(engine), r = random(engine);
    const auto a = d.invert({r, phi});
    const auto b = exact.invert({r, phi});
    see(worst.u, std::abs(static_cast<double>(b.u - a.u)));
    see(worst.v, std::abs(static_cast<double>(b.v - a.v)));
    const double found = a.pdf, here = static_cast<double>(b.pdf);
    see(worst.pdf, std::abs(here - found) / peak);
    low = high = here;
    for (const long double near_phi : within_4_epsilon(phi, g.phi))
      for (const long double near_r : within_4_epsilon(r, g.r)) {
        const double there = static_cast<double>(exact.pdf({near_r, near_phi}));
        low = std::min(low, there), high = std::max(high, there);
      }
    see(worst.pdf_relative, outside(found, low, high) / here);
  }
}

TEST(Precision, DiagramInFloat) {
  for (const double decades : {2.0, 12.0}) {
    Worst worst;
    for (const unsigned seed : {1u, 2u, 3u}) against_long_double(grid(seed, decades), worst);
    EXPECT_LE(worst.u, 4) << decades;
    EXPECT_LE(worst.v, 8) << decades;
    EXPECT_LE(worst.pdf, 4) << decades;
    EXPECT_LE(worst.pdf_relative, 16) << decades;
    EXPECT_LE(worst.phi_mass, 16) << decades;
    EXPECT_LE(worst.r_mass, 16) << decades;
  }
}

}  // namespace
}  // namespace gonio
