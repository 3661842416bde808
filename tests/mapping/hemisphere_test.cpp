#include <random>

#include <gtest/gtest.h>

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {
namespace {

TEST(Hemisphere, RadiusIsSqrtOfOneMinusCosine) {  // eq. 3; eq. 6 as printed gives 1 at the pole
  for (const double theta : {0.0, 1e-8, 0.3, 1.0, pi<double> / 2})
    EXPECT_NEAR(theta_to_radius(theta), std::sqrt(1 - std::cos(theta)), 1e-15 + 1e-8 * (theta < 1e-3));
  EXPECT_DOUBLE_EQ(theta_to_radius(1e-8), 1e-8 / std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(theta_to_radius(0.0), 0);
  for (const double r : {0.0, 1e-9, 0.5, 1.0}) EXPECT_NEAR(theta_to_radius(radius_to_theta(r)), r, 1e-15);
}

TEST(Hemisphere, UnitVectorsAndRoundTripNextToThePole) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> random;
  for (int k = 0; k < 100000; ++k) {
    const float r = k % 2 ? random(engine) : std::pow(10.0f, -7 * random(engine));
    const float phi = pi<float> * (2 * random(engine) - 1);
    const Vec3<float> w = polar_to_direction(Polar<float>{r, phi});
    ASSERT_NEAR(w.x * w.x + w.y * w.y + w.z * w.z, 1, 4e-7);
    const Polar<float> p = direction_to_polar(w);
    ASSERT_NEAR(p.r, r, 4e-7f * r);  // relative: 1 - w.z would leave nothing at r = 1e-7
    ASSERT_NEAR(p.phi, phi, 1e-6);
  }
}

// The error of reading a theta-linear diagram as r-linear (Havran section 3.2). Their eq. 5 lacks
// the "- r_1", which matters for every interval but the first.
struct LinearityError {
  double absolute = 0, relative = 0;
};

LinearityError linearity_error(double theta1, double theta2, double d1, double d2) {
  const double r1 = theta_to_radius(theta1), r2 = theta_to_radius(theta2);
  LinearityError worst;
  for (int k = 1; k < 20000; ++k) {
    const double theta = theta1 + (theta2 - theta1) * k / 20000;
    const double correct = d1 + (theta - theta1) / (theta2 - theta1) * (d2 - d1);
    const double real = d1 + (d2 - d1) * (theta_to_radius(theta) - r1) / (r2 - r1);
    worst.absolute = std::max(worst.absolute, std::abs(real - correct) / std::max(d1, d2));
    worst.relative = std::max(worst.relative, std::abs(real - correct) / correct);
  }
  return worst;
}

TEST(Hemisphere, RadiusToThetaInFloat) {
  for (int k = 1; k <= 100000; ++k) {
    const float r = static_cast<float>(k) / 100000;
    ASSERT_NEAR(double(radius_to_theta(r)) / radius_to_theta(double(r)), 1, 2e-7) << r;
  }
  EXPECT_EQ(radius_to_theta(0.0f), 0.0f);
}

TEST(Hemisphere, LinearityErrorOfThePaper) {
  const LinearityError two = linearity_error(0, pi<double> / 2, 1, 0);
  EXPECT_NEAR(two.absolute, 0.0422, 1e-4);  // paper: 4.2 %
  EXPECT_NEAR(two.relative, 0.215, 1e-3);   // paper: 21.5 %
  // The paper's "N = 10" is reached with ten intervals, in the last one, on the same ramp.
  LinearityError ten;
  for (int k = 0; k < 10; ++k) {
    const double a = k * pi<double> / 20, b = (k + 1) * pi<double> / 20;
    const LinearityError e = linearity_error(a, b, 1, 0);
    ten.absolute = std::max(ten.absolute, e.absolute);
    ten.relative = std::max(ten.relative, e.relative);
  }
  EXPECT_NEAR(ten.absolute, 0.0091, 3e-4);  // paper: 0.9 %
  EXPECT_NEAR(ten.relative, 0.037, 2e-3);   // paper: 3.6 %
}

TEST(Hemisphere, Equation5AsPrintedIsWrongBeyondTheFirstInterval) {
  const double theta1 = 0.5, theta2 = 1.0, r1 = theta_to_radius(theta1), r2 = theta_to_radius(theta2);
  const auto printed = [&](double theta) { return 1 + (0.0 - 1) * theta_to_radius(theta) / (r2 - r1); };
  EXPECT_GT(std::abs(printed(theta1) - 1), 0.5);  // should be d1 = 1 at theta1
}

}  // namespace
}  // namespace gonio
