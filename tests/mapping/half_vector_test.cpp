#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <gonio/mapping/charts/half_vector.h>

namespace gonio {
namespace {

using Wide = long double;
constexpr double degree = pi<double> / 180;

const double angles[] = {0, 1e-4, 0.2, 0.8, 1.2, 80 * degree, 85 * degree, 89 * degree, 89.8 * degree};

Wide dot(const Vec3<Wide>& a, const Vec3<Wide>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Wide largest_difference(const Vec3<Wide>& a, const Vec3<Wide>& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// Points of the disk, the neighbourhood of pole and rim among them.
Polar<double> any_point(std::mt19937& engine) {
  std::uniform_real_distribution<double> random;
  const double t = random(engine), phi = pi<double> * (2 * random(engine) - 1);
  switch (engine() % 4) {
    case 0:
      return {std::pow(10.0, -6 * t), phi};
    case 1:
      return {1 - std::pow(10.0, -6 * t), phi};
    default:
      return {t, phi};
  }
}

// The definition, straight from the geometry: h is at (theta_h, phi), wo is wi mirrored at h, and the
// rim is where wo meets the horizon.
TEST(HalfVector, FollowsItsDefinition) {
  std::mt19937 engine(1);
  for (const double theta_i : angles) {
    const Wide si = std::sin(Wide(theta_i)), ci = std::cos(Wide(theta_i));
    const Vec3<Wide> wi(si, 0, ci);
    const Wide a = (2 * std::cos(Wide(theta_i) / 2) + std::sqrt(Wide(2))) / ci;
    const HalfVectorChart<Wide> chart(theta_i);
    for (int k = 0; k < 2000; ++k) {
      const Polar<double> p = any_point(engine);
      const Wide theta_max = std::atan2(ci, -si * std::cos(Wide(p.phi))) / 2;
      const Wide m = 2 * std::sin(theta_max / 2) * std::sin(theta_max / 2);
      const Wide q = Wide(p.r) * p.r, x = q / (a * (1 - q) + q / m), theta_h = 2 * std::asin(std::sqrt(x / 2));
      const Vec3<Wide> h(std::sin(theta_h) * std::cos(Wide(p.phi)), std::sin(theta_h) * std::sin(Wide(p.phi)),
                         std::cos(theta_h));
      const Vec3<Wide> wo = 2 * dot(wi, h) * h - wi;
      const auto found = chart.direction({p.r, p.phi});
      ASSERT_LT(largest_difference(found.wo, wo), 1e-15L) << theta_i << ' ' << p.r << ' ' << p.phi;
      ASSERT_GE(found.wo.z, 0);
    }
    for (const double phi : {-3.0, 0.0, 0.4, 1.6, 3.1}) {
      EXPECT_EQ(chart.direction({1, phi}).wo.z, 0);
      EXPECT_NEAR(static_cast<double>(largest_difference(chart.direction({0, phi}).wo, {-si, 0, ci})), 0, 1e-15);
    }
  }
}

TEST(HalfVector, AtNormalIncidenceItHalvesTheAngle) {
  const HalfVectorChart<double> chart(0);
  for (const double r : {0.1, 0.5, 0.9}) {
    const auto wo = chart.direction({r, 0.7}).wo;
    EXPECT_NEAR(std::atan2(wo.y, wo.x), 0.7, 1e-14);
    EXPECT_NEAR(1 - std::cos(std::acos(wo.z) / 2), r * r * (1 - std::sqrt(0.5)), 1e-14);
  }
}

// Nothing of eq. 3 is used: the area that a small square of the disk covers on the sphere.
TEST(HalfVector, JacobianIsTheAreaRatio) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> random;
  for (const double theta_i : angles) {
    const HalfVectorChart<Wide> chart(theta_i);
    for (int k = 0; k < 500; ++k) {
      const Wide r = 0.01 + 0.98 * random(engine), phi = 6 * random(engine) - 3, e = 1e-6L;
      const auto at = [&](Wide dr, Wide dphi) { return chart.direction({r + dr, phi + dphi}).wo; };
      const auto a = (at(e, 0) - at(-e, 0)) / (2 * e), b = (at(0, e) - at(0, -e)) / (2 * e);
      const Vec3<Wide> n(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
      const Wide area = std::sqrt(dot(n, n)) / (2 * r);
      const Wide found = chart.direction({r, phi}).jacobian;
      ASSERT_NEAR(static_cast<double>(found / area), 1, 1e-6)
          << theta_i << ' ' << static_cast<double>(r) << ' ' << static_cast<double>(phi);
      ASSERT_NEAR(static_cast<double>(chart.disk(at(0, 0)).jacobian / found), 1, 1e-9);
    }
  }
}

// The whole hemisphere and nothing else: the solid angles of the disk sum up to 2 pi.
TEST(HalfVector, CoversTheHemisphereOnce) {
  for (const double theta_i : {0.0, 0.5, 1.2, 80 * degree}) {
    const HalfVectorChart<double> chart(theta_i);
    constexpr int side = 1000;
    double sum = 0;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const Polar<double> p{(j + 0.5) / side, 2 * pi<double> * (i + 0.5) / side - pi<double>};
        sum += chart.direction(p).jacobian * 2 * p.r / side * 2 * pi<double> / side;
      }
    EXPECT_NEAR(sum / (2 * pi<double>), 1, 1e-4) << theta_i;
  }
}

struct Errors {
  Wide direction = 0, round_trip = 0, jacobian = 0, length = 0;
};

/// Of T against long double on the same T inputs; the chart's own angle is that of T too.
template <class T>
Errors errors(double theta_i) {
  std::mt19937 engine(3);
  const HalfVectorChart<T> chart(static_cast<T>(theta_i));
  const HalfVectorChart<Wide> exact(static_cast<T>(theta_i));
  Errors e;
  for (int k = 0; k < 100000; ++k) {
    const Polar<double> any = any_point(engine);
    const Polar<T> p{static_cast<T>(any.r), static_cast<T>(any.phi)};
    const auto found = chart.direction(p);
    const auto right = exact.direction({p.r, p.phi});
    const Vec3<Wide> wo(found.wo);
    e.direction = std::max(e.direction, largest_difference(wo, right.wo));
    e.length = std::max(e.length, std::abs(std::sqrt(dot(wo, wo)) - 1));
    e.jacobian = std::max(e.jacobian, std::abs(found.jacobian / right.jacobian - 1));
    // Back and forth again, in T throughout.
    e.round_trip =
        std::max(e.round_trip, largest_difference(Vec3<Wide>(chart.direction(chart.disk(found.wo).at).wo), wo));
    EXPECT_TRUE(found.wo.z > 0 || p.r == 1);
  }
  return e;
}

TEST(HalfVector, PrecisionAsStated) {
  for (const double theta_i : angles) {
    for (const auto& [e, epsilon] :
         {std::pair(errors<float>(theta_i), 0x1p-23L), std::pair(errors<double>(theta_i), 0x1p-52L)}) {
      EXPECT_LE(e.direction, 8 * epsilon) << theta_i;
      EXPECT_LE(e.length, 8 * epsilon) << theta_i;
      EXPECT_LE(e.jacobian, 16 * epsilon) << theta_i;
      EXPECT_LE(e.round_trip, 8 * epsilon / std::cos(theta_i)) << theta_i;
    }
  }
}

TEST(HalfVector, FiniteAtAndBeyondGrazing) {
  for (const float theta_i : {89.95f * pi<float> / 180, pi<float> / 2, 2.0f}) {
    const HalfVectorChart<float> chart(theta_i);
    for (const float r : {0.0f, 1e-20f, 0.5f, 1 - 0x1p-24f, 1.0f})
      for (const float phi : {-pi<float>, -1.0f, 0.0f, 1.5707963f, 3.0f, pi<float>}) {
        const auto d = chart.direction({r, phi});
        ASSERT_TRUE(std::isfinite(d.jacobian) && d.jacobian > 0) << r << ' ' << phi;
        ASSERT_TRUE(d.wo.z > 0 || r == 1);
        const auto p = chart.disk(d.wo);
        ASSERT_TRUE(p.at.r >= 0 && p.at.r <= 1 && std::isfinite(p.at.phi) && p.jacobian > 0 &&
                    std::isfinite(p.jacobian));
      }
  }
}

}  // namespace
}  // namespace gonio
