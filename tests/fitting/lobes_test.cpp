#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <gonio/fitting/model/model.h>

namespace gonio {
namespace {

using Vec = glm::dvec3;

struct Case {
  LobeKind kind;
  double shape[max_shape];
};

// Every lobe, wide and narrow.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {LobeKind::lambert, {0, 0}},
      {LobeKind::oren_nayar, {0.1, 0}},
      {LobeKind::oren_nayar, {1.2, 0}},
      {LobeKind::burley, {0.1, 0}},
      {LobeKind::burley, {0.9, 0}},
      {LobeKind::ggx, {0.05, 0}},
      {LobeKind::ggx, {0.3, 0}},
      {LobeKind::ggx, {1.0, 0}},
      {LobeKind::beckmann, {0.05, 0}},
      {LobeKind::beckmann, {0.4, 0}},
      {LobeKind::student_t, {0.05, 1.7}},
      {LobeKind::student_t, {0.3, 1.7}},
      {LobeKind::student_t, {0.3, 5.0}},
      {LobeKind::blinn_phong, {5, 0}},
      {LobeKind::blinn_phong, {400, 0}},
      {LobeKind::ward, {0.05, 0}},
      {LobeKind::ward, {0.5, 0}},
      {LobeKind::ashikhmin_shirley, {5, 0}},
      {LobeKind::ashikhmin_shirley, {400, 0}},
      {LobeKind::lafortune, {8, 1}},
      {LobeKind::lafortune, {200, 0.8}},
      {LobeKind::lafortune, {30, 0.5}},
  };
  return all;
}

std::string text(const Case& c) {
  return std::string(lobe_info(c.kind).id) + " " + std::to_string(c.shape[0]) + " " + std::to_string(c.shape[1]);
}

double eval(const Case& c, const Vec& wi, const Vec& wo) {
  const Angles<double> a(wi, wo);
  return visit_lobe(c.kind, c.shape, [&](const auto& lobe) { return lobe.eval(a); });
}

double pdf(const Case& c, const Vec& wi, const Vec& wo) {
  const Angles<double> a(wi, wo);
  return visit_lobe(c.kind, c.shape, [&](const auto& lobe) { return lobe.pdf(a); });
}

std::optional<Vec> sample(const Case& c, const Vec& wi, double u, double v) {
  return visit_lobe(c.kind, c.shape, [&](const auto& lobe) { return lobe.sample(wi, u, v); });
}

Vec direction(double theta, double phi = 0) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

constexpr double degree = pi<double> / 180;

// Integral over the hemisphere of wo, in half-vector coordinates (dwo = 4 cos_d dh), where every
// lobe is smooth, with tan(theta_h) spaced to resolve narrow ones.
template <class F>
double integrate(const Vec& wi, const F& f) {
  const int n_theta = 600, n_phi = 180;
  double sum = 0;
  for (int i = 0; i < n_theta; ++i) {
    const double s = (i + 0.5) / n_theta, theta = s * s * s * pi<double> / 2;
    const double d_theta = 3 * s * s * pi<double> / 2 / n_theta;
    for (int j = 0; j < n_phi; ++j) {
      const double phi = 2 * pi<double> * (j + 0.5) / n_phi;
      const Vec h = direction(theta, phi);
      const double cos_d = glm::dot(wi, h);
      if (cos_d <= 0) continue;
      const Vec wo = reflect_about(wi, h);
      if (wo.z <= 0) continue;
      sum += f(wo) * 4 * cos_d * std::sin(theta) * d_theta * 2 * pi<double> / n_phi;
    }
  }
  return sum;
}

double albedo(const Case& c, const Vec& wi) {
  return integrate(wi, [&](const Vec& wo) { return eval(c, wi, wo) * wo.z; });
}

TEST(Lobes, PdfIntegratesToTheShareOfDrawsThatAreValid) {
  for (const Case& c : cases()) {
    for (double theta : {2.0, 45.0, 80.0}) {
      const Vec wi = direction(theta * degree, 0.4);
      const int n = 256;
      int valid = 0;
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) valid += bool(sample(c, wi, (i + 0.5) / n, (j + 0.5) / n));
      }
      const double total = integrate(wi, [&](const Vec& wo) { return pdf(c, wi, wo); });
      EXPECT_NEAR(total, double(valid) / (n * n), 0.006) << text(c) << " at " << theta;
    }
  }
}

// Counts of draws against the integral of the pdf in cells of wo. The worst cell's deviation is
// compared with its binomial standard deviation; the negative control is a wrong pdf.
double worst_deviation(const Case& c, const Case& claimed, const Vec& wi) {
  const int rows = 6, columns = 8, draws = 100000;
  std::vector<double> counts(rows * columns), expected(rows * columns);
  const auto cell = [&](const Vec& wo) {
    const int row = std::min(rows - 1, int(rows * (1 - wo.z)));
    const double turn = std::atan2(wo.y, wo.x) / (2 * pi<double>)+0.5;
    return row * columns + std::min(columns - 1, int(columns * turn));
  };
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < draws; ++i) {
    const double u = uniform(random), v = uniform(random);
    if (const auto wo = sample(c, wi, u, v)) counts[cell(*wo)] += 1;
  }
  // Cells of wo integrated on a fine grid of half vectors.
  const int n_theta = 600, n_phi = 180;
  for (int i = 0; i < n_theta; ++i) {
    const double s = (i + 0.5) / n_theta, theta = s * s * s * pi<double> / 2;
    const double d_theta = 3 * s * s * pi<double> / 2 / n_theta;
    for (int j = 0; j < n_phi; ++j) {
      const Vec h = direction(theta, 2 * pi<double> * (j + 0.5) / n_phi);
      const double cos_d = glm::dot(wi, h);
      const Vec wo = reflect_about(wi, h);
      if (cos_d <= 0 || wo.z <= 0) continue;
      expected[cell(wo)] +=
          pdf(claimed, wi, wo) * 4 * cos_d * std::sin(theta) * d_theta * 2 * pi<double> / n_phi * draws;
    }
  }
  double worst = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    // 1 % of the expectation allows for the quadrature at the edges of the cells.
    const double sigma = std::sqrt(expected[i] + 1) + 0.01 * expected[i];
    worst = std::fmax(worst, std::fabs(counts[i] - expected[i]) / sigma);
  }
  return worst;
}

TEST(Lobes, DrawsFollowThePdf) {
  for (const Case& c : cases()) {
    for (double theta : {0.0, 30.0, 75.0}) {
      const Vec wi = direction(theta * degree, -1.1);
      EXPECT_LT(worst_deviation(c, c, wi), 5) << text(c) << " at " << theta;
    }
  }
}

TEST(Lobes, AWrongPdfIsFound) {
  const Vec wi = direction(30 * degree, -1.1);
  EXPECT_GT(worst_deviation({LobeKind::ggx, {0.3, 0}}, {LobeKind::ggx, {0.33, 0}}, wi), 5);
  EXPECT_GT(worst_deviation({LobeKind::ward, {0.5, 0}}, {LobeKind::beckmann, {0.55, 0}}, wi), 5);
}

TEST(Lobes, Reciprocal) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Case& c : cases()) {
    for (int i = 0; i < 200; ++i) {
      const double ti = std::acos(uniform(random)), to = std::acos(uniform(random));
      const Vec wi = direction(ti, 6 * uniform(random)), wo = direction(to, 6 * uniform(random));
      const double forward = eval(c, wi, wo);
      EXPECT_NEAR(forward, eval(c, wo, wi), 1e-9 * forward + 1e-300) << text(c);
      EXPECT_GE(forward, 0);
      EXPECT_GE(pdf(c, wi, wo), 0);
    }
  }
}

TEST(Lobes, SpecularLobesReflectAtMostWhatTheyReceive) {
  for (const Case& c : cases()) {
    if (!is_specular(c.kind)) continue;
    for (double theta : {0.0, 20.0, 50.0, 70.0, 85.0}) {
      const double e = albedo(c, direction(theta * degree));
      EXPECT_LE(e, 1.003) << text(c) << " at " << theta;
      EXPECT_GT(e, 0) << text(c) << " at " << theta;
    }
  }
}

TEST(Lobes, StatedEnergies) {
  const auto at = [](LobeKind kind, double a, double b, double theta) {
    return albedo({kind, {a, b}}, direction(theta * degree));
  };
  EXPECT_NEAR(at(LobeKind::lambert, 0, 0, 50), 1, 2e-3);
  EXPECT_NEAR(at(LobeKind::blinn_phong, 40, 0, 0), 1, 2e-3);
  EXPECT_NEAR(at(LobeKind::lafortune, 40, 1, 0), 1, 2e-3);
  EXPECT_NEAR(at(LobeKind::lafortune, 40, 0.7, 0), 1, 2e-3);
  EXPECT_NEAR(at(LobeKind::ggx, 0.02, 0, 30), 1, 4e-3);
  EXPECT_NEAR(at(LobeKind::beckmann, 0.02, 0, 30), 1, 4e-3);
  for (double sigma : {0.3, 1.0}) {
    for (double theta : {20.0, 60.0}) {
      const double s2 = sigma * sigma, t = theta * degree, sin_t = std::sin(t);
      const double a = 1 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
      const double closed =
          a +
          b / pi<double> * (sin_t * (t - sin_t * std::cos(t)) + 2.0 / 3 * std::tan(t) * (1 - sin_t * sin_t * sin_t));
      EXPECT_NEAR(at(LobeKind::oren_nayar, sigma, 0, theta), closed, 2e-3);
    }
  }
  for (double roughness : {0.1, 1.0}) {
    EXPECT_LT(at(LobeKind::burley, roughness, 0, 60), 1.2);
  }
}

TEST(Lobes, StudentTOfGammaTwoIsGgx) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 300; ++i) {
    const Vec wi = direction(1.5 * uniform(random));
    const Vec wo = direction(1.5 * uniform(random), 6 * uniform(random));
    for (double alpha : {0.1, 0.4}) {
      const double ggx = eval({LobeKind::ggx, {alpha, 0}}, wi, wo);
      EXPECT_NEAR(eval({LobeKind::student_t, {alpha, 2}}, wi, wo), ggx, 1e-6 * ggx);
    }
  }
}

// Lambda read off f_r at wo = normal, where nothing shadows, against the integral that defines it.
TEST(Lobes, StudentTMaskingIsTheSmithTermOfItsSlopes) {
  for (double gamma : {1.8, 3.0, 10.0}) {
    for (double alpha : {0.1, 0.8}) {
      for (double theta : {30.0, 60.0, 85.0}) {
        const double b = (gamma - 1) * alpha * alpha, c = 1 / std::tan(theta * degree);
        double above = 0, all = 0;
        for (int i = 0; i < 200000; ++i) {  // slope x = sqrt(b) tan(t)
          const double t = (i + 0.5) / 200000 * pi<double> / 2, x = std::sqrt(b) * std::tan(t);
          const double p = std::pow(std::cos(t), 2 * gamma - 3);
          all += 2 * p;
          if (x > c) above += (x / c - 1) * p;
        }
        const Vec wi = direction(theta * degree);
        const Angles<double> a(wi, Vec(0, 0, 1));
        const double d = pdf({LobeKind::student_t, {alpha, gamma}}, wi, Vec(0, 0, 1)) * 4 * a.cos_d / a.cos_h;
        const double f = eval({LobeKind::student_t, {alpha, gamma}}, wi, Vec(0, 0, 1));
        EXPECT_NEAR(d / (4 * a.cos_i * f), 1 + above / all, 5e-3 * (1 + above / all))
            << gamma << " " << alpha << " " << theta;
      }
    }
  }
}

TEST(Lobes, DerivativesAgreeWithDifferences) {
  using Jet = ceres::Jet<double, max_shape>;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Case& c : cases()) {
    for (int i = 0; i < 50; ++i) {
      const Vec wi = direction(1.4 * uniform(random)), wo = direction(1.4 * uniform(random), 2 + 2 * uniform(random));
      const Angles<double> a(wi, wo);
      const Jet shape[max_shape] = {Jet(c.shape[0], 0), Jet(c.shape[1], 1)};
      const Jet value = visit_lobe(c.kind, shape, [&](const auto& lobe) { return lobe.eval(a); });
      EXPECT_NEAR(value.a, eval(c, wi, wo), 1e-12 * value.a);
      for (size_t p = 0; p < lobe_info(c.kind).shape.size(); ++p) {
        const double step = 1e-5 * c.shape[p];
        Case up = c, down = c;
        up.shape[p] += step;
        down.shape[p] -= step;
        const double difference = (eval(up, wi, wo) - eval(down, wi, wo)) / (2 * step);
        EXPECT_NEAR(value.v[p], difference, 1e-4 * (std::fabs(difference) + value.a / c.shape[p]) + 1e-250)
            << text(c) << " parameter " << p;
      }
    }
  }
}

TEST(Lobes, FloatFollowsDouble) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Case& c : cases()) {
    const float shape[max_shape] = {float(c.shape[0]), float(c.shape[1])};
    for (int i = 0; i < 200; ++i) {
      const Vec wi = direction(1.5 * uniform(random));
      const auto wo = sample(c, wi, uniform(random), uniform(random));
      if (!wo) continue;
      const Angles<float> a{glm::vec3(wi), glm::vec3(*wo)};
      const double value = visit_lobe(c.kind, shape, [&](const auto& lobe) { return lobe.eval(a); });
      const double exact = eval(c, wi, *wo);
      EXPECT_NEAR(value, exact, 1e-3 * exact + 1e-6) << text(c);
    }
  }
}

TEST(Fresnel, SchlickAndConductorAtTheirEnds) {
  EXPECT_DOUBLE_EQ(schlick(0.04, 1.0, 1.0), 0.04);
  EXPECT_DOUBLE_EQ(schlick(0.04, 0.8, 0.0), 0.8);
  const double eta = 0.2, k = 3.9;
  const double normal = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
  EXPECT_NEAR(conductor(eta, k, 1.0), normal, 1e-12);
  EXPECT_NEAR(conductor(eta, k, 0.0), 1, 1e-12);
  // A dielectric (k = 0) of index 1.5 at Brewster's angle: R_p = 0, R = R_s / 2 (Fresnel).
  const double brewster = std::atan(1.5), refracted = std::asin(std::sin(brewster) / 1.5);
  const double rs = std::sin(brewster - refracted) / std::sin(brewster + refracted);
  EXPECT_NEAR(conductor(1.5, 0.0, std::cos(brewster)), rs * rs / 2, 1e-12);
}

TEST(Lobes, EachCitesItsSourceAndNamesItsParameters) {
  for (LobeKind kind : lobe_kinds()) {
    EXPECT_NE(std::string(lobe_info(kind).source), "");
    for (const Parameter& p : lobe_info(kind).shape) {
      EXPECT_LT(p.min, p.max);
      EXPECT_GE(p.initial, p.min);
      EXPECT_LE(p.initial, p.max);
    }
  }
}

}  // namespace
}  // namespace gonio
