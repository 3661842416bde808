#include <gonio/brdf/ndf/radial_ndf.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <gonio/mapping/concentric.h>
#include <gonio/mapping/error.h>

namespace gonio {
namespace {

// Gauss-Legendre on [0, 1], n = 4.
constexpr double gauss_node[] = {0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026};
constexpr double gauss_weight[] = {0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727};

double theta_of(double u) noexcept { return pi<double> / 2 * u * u; }

/// The integral of max(k . h, 0) over the azimuth of h.
double over_azimuth(double theta_k, double theta_h) noexcept {
  const double a = std::cos(theta_k) * std::cos(theta_h), b = std::sin(theta_k) * std::sin(theta_h);
  if (a >= b) return 2 * pi<double> * a;
  const double root = std::sqrt((b - a) * (b + a));
  return 2 * (a * std::atan2(root, -a) + root);
}

/// Calls function(interval, fraction in it, theta, solid angle per azimuth) for all Gauss points of n
/// nodes.
template <class Function>
void for_each_point(int n, const Function& function) {
  for (int k = 0; k + 1 < n; ++k)
    for (int q = 0; q < 4; ++q) {
      const double u = (k + gauss_node[q]) / (n - 1), theta = theta_of(u);
      function(k, gauss_node[q], theta, std::sin(theta) * pi<double> * u * gauss_weight[q] / (n - 1));
    }
}

double lerp(const std::vector<double>& values, int k, double t) {
  const auto i = static_cast<std::size_t>(k);
  return values[i] + t * (values[i + 1] - values[i]);
}

}  // namespace

RadialNdf::RadialNdf(int nodes, const std::function<double(double)>& density) {
  if (nodes < 2) throw Error("radial normal distribution: found " + std::to_string(nodes) + " nodes, expected 2 or more");
  for (int k = 0; k < nodes; ++k) {
    const double theta = theta_of(k / (nodes - 1.0)), value = density(theta);
    if (!(value >= 0 && std::isfinite(value)))
      throw Error("radial normal distribution: at " + std::to_string(theta * 180 / pi<double>) + " degrees: found " +
                  std::to_string(value) + ", expected a finite value from 0");
    values_.push_back(value);
  }
}

double RadialNdf::eval(double theta) const noexcept {
  const int last = static_cast<int>(values_.size()) - 1;
  const double at = std::sqrt(std::clamp(theta * 2 / pi<double>, 0.0, 1.0)) * last;
  const int k = std::min(static_cast<int>(at), last - 1);
  return lerp(values_, k, at - k);
}

double RadialNdf::projected_area() const noexcept {
  double sum = 0;
  for_each_point(static_cast<int>(values_.size()), [&](int k, double t, double theta, double weight) {
    sum += 2 * pi<double> * std::cos(theta) * weight * lerp(values_, k, t);
  });
  return sum;
}

double RadialNdf::normalise() {
  const double before = projected_area();
  if (!(before > 0)) throw Error("radial normal distribution: found 0 everywhere, expected some density");
  for (double& value : values_) value /= before;
  return before;
}

double RadialNdf::sigma(double theta) const noexcept {
  double sum = 0;
  for_each_point(static_cast<int>(values_.size()), [&](int k, double t, double theta_h, double weight) {
    sum += over_azimuth(theta, theta_h) * weight * lerp(values_, k, t);
  });
  return sum;
}

double RadialNdf::g1(double theta) const noexcept {
  const double area = sigma(theta);
  return area > 0 ? std::cos(theta) / area : 0;
}

double RadialNdf::median_theta() const noexcept {
  const double half = projected_area() / 2;
  double below = 0, previous = 0, result = pi<double> / 2;
  bool found = false;
  for_each_point(static_cast<int>(values_.size()), [&](int k, double t, double theta, double weight) {
    const double mass = 2 * pi<double> * std::cos(theta) * weight * lerp(values_, k, t);
    if (!found && below + mass >= half) {
      result = previous + (theta - previous) * (mass > 0 ? (half - below) / mass : 0);
      found = true;
    }
    below += mass;
    previous = theta;
  });
  return result;
}

ExtractedNdf extract_ndf(const std::function<double(double)>& retro_reflection, int nodes) {
  constexpr double last_measured = 89 * pi<double> / 180;
  RadialNdf weight(nodes, [&](double theta) {
    const double at = std::min(theta, last_measured);
    return retro_reflection(at) * std::cos(at);
  });
  const auto n = static_cast<std::size_t>(nodes);
  // kernel[i][j]: what the value at node j adds at node i.
  std::vector<double> kernel(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    const double theta_k = theta_of(static_cast<double>(i) / static_cast<double>(n - 1));
    for_each_point(nodes, [&](int k, double t, double theta_h, double solid_angle) {
      const double value = weight.values()[i] * over_azimuth(theta_k, theta_h) * solid_angle;
      const std::size_t j = i * n + static_cast<std::size_t>(k);
      kernel[j] += (1 - t) * value;
      kernel[j + 1] += t * value;
    });
  }
  std::vector<double> d(n, 1.0), next(n);
  int iterations = 0;
  double change = 1;
  while (iterations < 1000 && change > 1e-12) {
    ++iterations;
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      next[i] = 0;
      for (std::size_t j = 0; j < n; ++j) next[i] += kernel[i * n + j] * d[j];
      largest = std::max(largest, next[i]);
    }
    if (!(largest > 0)) throw Error("retro-reflection: found none, expected some to extract normals from");
    change = 0;
    for (std::size_t i = 0; i < n; ++i) {
      next[i] /= largest;
      change = std::max(change, std::abs(next[i] - d[i]) / std::max(next[i], 1e-12));
    }
    d.swap(next);
  }
  RadialNdf ndf(nodes, [&](double theta) {
    return d[static_cast<std::size_t>(std::lround(std::sqrt(theta * 2 / pi<double>) * (nodes - 1)))];
  });
  ndf.normalise();
  return {std::move(ndf), iterations, change};
}

ExtractedNdf extract_ndf(const BrdfTable& table, int nodes) {
  return extract_ndf(
      [&](double theta) {
        const glm::vec3 k(static_cast<float>(std::sin(theta)), 0.0f, static_cast<float>(std::cos(theta)));
        return static_cast<double>(luminance(table.eval(k, k)));
      },
      nodes);
}

}  // namespace gonio
