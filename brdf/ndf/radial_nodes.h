#pragma once

#include <cmath>
#include <string>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/charts/concentric.h>

/// The nodes of RadialNdf and integrals over them; not installed.
namespace gonio::detail {

// Gauss-Legendre on [0, 1], n = 4.
inline constexpr double gauss_node[] = {0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026};
inline constexpr double gauss_weight[] = {0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727};

/// @throws Error if they are fewer than two
inline int checked_nodes(int nodes) {
  if (nodes < 2)
    throw Error("radial normal distribution: found " + std::to_string(nodes) + " nodes, expected 2 or more");
  return nodes;
}

/// theta = (pi/2) u^2.
inline double theta_of(double u) noexcept { return pi<double> / 2 * u * u; }

/// The integral of max(k . h, 0) over the azimuth of h.
inline double over_azimuth(double theta_k, double theta_h) noexcept {
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

}  // namespace gonio::detail
