#include <cmath>

#include <gtest/gtest.h>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/diagram/diagram_fit.h>

namespace gonio {
namespace {

// Relative variance of sampling `g` by the diagram: the divergence that the fit minimises.
double relvar(const DiagramGrid& grid, const std::function<double(Polar<double>)>& g) {
  const Diagram<double> d(grid);
  constexpr int side = 300;
  double sum = 0, sum2 = 0;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const auto s = d.sample((i + 0.5) / side, (j + 0.5) / side);
      const double w = g(s.at) / s.pdf;
      sum += w, sum2 += w * w;
    }
  }
  return sum2 * side * side / (sum * sum) - 1;
}

double lobe(Polar<double> p, double width) {
  const double dx = p.r * std::cos(p.phi) + 0.5, dy = p.r * std::sin(p.phi);
  return std::exp(-(dx * dx + dy * dy) / (width * width)) + 0.02 * (1 - p.r * p.r);
}

TEST(Fit, FindsANarrowLobe) {
  for (const double width : {0.3, 0.1, 0.03}) {
    const auto g = [&](Polar<double> p) { return lobe(p, width); };
    EXPECT_LT(relvar(fit_diagram(g, Azimuth::half, {32, 32, 0}), g), 2e-3) << width;
  }
}

TEST(Fit, StopsAtTheTolerance) {
  const auto g = [](Polar<double> p) { return lobe(p, 0.1); };
  const DiagramGrid coarse = fit_diagram(g, Azimuth::half, {40, 40, 0.02}),
                    fine = fit_diagram(g, Azimuth::half, {40, 40, 0.002});
  EXPECT_LT(coarse.density.size(), fine.density.size());
  EXPECT_LT(fine.density.size(), 40u * 40u);
  EXPECT_LT(relvar(coarse, g), 0.02);
  EXPECT_LT(relvar(fine, g), 0.002);
}

// The placement is what limits quality: evenly spaced lines of the same number do far worse.
TEST(Fit, BeatsEvenLines) {
  const auto g = [](Polar<double> p) { return lobe(p, 0.05); };
  DiagramGrid even;
  for (int i = 0; i < 24; ++i) even.phi.push_back(pi<double> * i / 23);
  for (int j = 0; j < 24; ++j) even.r.push_back(j / 23.0);
  for (const double phi : even.phi)
    for (const double r : even.r) even.density.push_back(g({r, phi}) + 1e-9);
  EXPECT_GT(relvar(even, g), 10 * relvar(fit_diagram(g, Azimuth::half, {24, 24, 0}), g));
}

TEST(Fit, ConstantNeedsTwoLinesAndFullAzimuthClosesTheSeam) {
  const DiagramGrid constant = fit_diagram([](Polar<double>) { return 3.0; }, Azimuth::half);
  EXPECT_EQ(constant.density.size(), 4u);
  const auto turned = [](Polar<double> p) { return 1.1 + std::cos(p.phi - 0.3) * p.r; };
  const DiagramGrid full = fit_diagram(turned, Azimuth::full);
  EXPECT_LT(relvar(full, turned), 2e-3);  // Diagram refuses a seam that does not close
}

TEST(Fit, BadValuesCountAsZero) {
  const auto holes = [](Polar<double> p) { return p.r < 0.3 ? std::nan("") : p.r > 0.8 ? -1.0 : 1.0; };
  const DiagramGrid grid = fit_diagram(holes, Azimuth::half);
  for (const double d : grid.density) EXPECT_TRUE(std::isfinite(d) && d >= 0);
  const DiagramGrid zero = fit_diagram([](Polar<double>) { return 0.0; }, Azimuth::half);
  for (const double d : zero.density) EXPECT_EQ(d, 0);
  EXPECT_THROW(fit_diagram(holes, Azimuth::half, {1, 8, 0}), Error);
}

}  // namespace
}  // namespace gonio
