#include <cmath>
#include <string>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/sphere/sphere.h>

namespace gonio {
namespace {

void check_ascending(const std::vector<double>& lines, const char* name) {
  if (lines.size() < 2 || !(std::abs(lines.front()) <= 1e-6))
    throw Error(std::string("sphere: ") + name + ": found " + std::to_string(lines.size()) +
                " lines, expected at least 2, the first at 0");
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (!std::isfinite(lines[i]) || !(lines[i] > lines[i - 1]))
      throw Error(std::string("sphere: ") + name + "[" + std::to_string(i) + "]: found " + std::to_string(lines[i]) +
                  ", expected ascending values");
}

std::size_t check(const SphereGrid& grid) {
  check_ascending(grid.phi, "meridians");
  check_ascending(grid.theta, "parallels");
  if (std::abs(grid.phi.back() - 2 * pi<double>) > 1e-6)
    throw Error("sphere: meridians: found the last at " + std::to_string(grid.phi.back()) + ", expected 2 pi");
  std::size_t equator = 0;
  while (equator < grid.theta.size() && std::abs(grid.theta[equator] - pi<double> / 2) > 1e-6) ++equator;
  if (equator == grid.theta.size() ||
      (equator + 1 < grid.theta.size() && std::abs(grid.theta.back() - pi<double>) > 1e-6))
    throw Error("sphere: parallels: expected one at pi/2 and the last at pi/2 or pi");
  const std::size_t n = grid.theta.size(), count = grid.phi.size() * n;
  if (grid.density.size() != count)
    throw Error("sphere: density: found " + std::to_string(grid.density.size()) + " values, expected " +
                std::to_string(count));
  for (double d : grid.density)
    if (!std::isfinite(d) || d < 0)
      throw Error("sphere: density: found " + std::to_string(d) + ", expected finite values >= 0");
  for (std::size_t j = 0; j < n; ++j)
    if (grid.density[j] != grid.density[count - n + j])
      throw Error("sphere: density: the last meridian differs from the first at parallel " + std::to_string(j) +
                  ", expected the same values at phi = 0 and 2 pi");
  return equator;
}

}  // namespace

template <class T>
SphereDiagram<T>::SphereDiagram(const SphereGrid& grid) {
  equator_ = static_cast<int>(check(grid));
  const std::size_t m = grid.phi.size(), n = grid.theta.size();
  const std::size_t equator = static_cast<std::size_t>(equator_);
  meridians_ = static_cast<int>(m);
  parallels_ = static_cast<int>(n);
  values_.resize(2 * m + 2 * n + 2 * m * n);
  T* phi = values_.data();
  T* cumulative_phi = phi + m;
  T* theta = phi + 2 * m;
  T* radius = theta + n;
  T* density = radius + n;
  T* cumulative = density + m * n;
  for (std::size_t i = 0; i < m; ++i) phi[i] = static_cast<T>(grid.phi[i]);
  phi[0] = 0, phi[m - 1] = 2 * pi<T>;
  for (std::size_t j = 0; j < n; ++j) {
    theta[j] = static_cast<T>(grid.theta[j]);
    const double from_pole = j <= equator ? grid.theta[j] : pi<double> - grid.theta[j];
    radius[j] = static_cast<T>(theta_to_radius(from_pole));
  }
  theta[0] = radius[0] = 0;
  theta[equator] = pi<T> / 2, radius[equator] = 1;
  if (n - 1 > equator) theta[n - 1] = pi<T>, radius[n - 1] = 0;
  for (std::size_t i = 1; i < m; ++i)
    if (!(phi[i] > phi[i - 1])) throw Error("sphere: meridians: two lines coincide after rounding");
  for (std::size_t j = 1; j < n; ++j)
    if (!(j <= equator ? radius[j] > radius[j - 1] : radius[j] < radius[j - 1]))
      throw Error("sphere: parallels: two lines coincide after rounding");

  // As Diagram: scale to a pdf, round to T, then integrate what is stored, so that the map and its
  // pdf agree to rounding.
  const auto integrate = [&](std::size_t i, const auto* d, double* below) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (below) below[j] = sum;
      if (j + 1 == n) break;
      const double d0 = d[i * n + j], d1 = d[i * n + j + 1];
      const double r0 = radius[j], r1 = radius[j + 1];
      sum += j < equator ? RadialCell<double>{r0, r1 - r0, d0, d1}.mass(1)
                         : RadialCell<double>{r1, r0 - r1, d1, d0}.mass(1);
    }
    return sum;
  };
  double total = 0;
  for (std::size_t i = 0; i + 1 < m; ++i)
    total += (double(phi[i + 1]) - double(phi[i])) / 2 *
             (integrate(i, grid.density.data(), nullptr) + integrate(i + 1, grid.density.data(), nullptr));
  if (!(total > 0) || !std::isfinite(total))
    throw Error("sphere: density: the mass is " + std::to_string(total) + ", expected a positive finite number");
  scale_ = 1 / total;
  for (std::size_t k = 0; k < m * n; ++k) density[k] = static_cast<T>(grid.density[k] * scale_);

  std::vector<double> below(n);
  double sum = 0, previous = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const double next = integrate(i, density, below.data());
    for (std::size_t j = 0; j < n; ++j) cumulative[i * n + j] = static_cast<T>(below[j]);
    if (i > 0) sum += (double(phi[i]) - double(phi[i - 1])) * (previous + next) / 2;
    cumulative_phi[i] = static_cast<T>(sum);
    previous = next;
  }
}

template class SphereDiagram<float>;
template class SphereDiagram<double>;

}  // namespace gonio
