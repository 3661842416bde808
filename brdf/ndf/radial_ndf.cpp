#include <algorithm>
#include <cmath>
#include <string>

#include <gonio/brdf/ndf/radial_ndf.h>
#include <gonio/brdf/ndf/radial_nodes.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

using detail::for_each_point;
using detail::over_azimuth;
using detail::theta_of;

double lerp(const std::vector<double>& values, int k, double t) {
  const auto i = static_cast<std::size_t>(k);
  return values[i] + t * (values[i + 1] - values[i]);
}

}  // namespace

RadialNdf::RadialNdf(int nodes, const std::function<double(double)>& density) {
  const int n = detail::checked_nodes(nodes);
  for (int k = 0; k < n; ++k) {
    const double theta = theta_of(k / (n - 1.0)), value = density(theta);
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

}  // namespace gonio
