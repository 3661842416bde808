#pragma once

#include <algorithm>
#include <cmath>

namespace gonio {

/// The range of azimuth between two meridians `width` apart, with a marginal density that is linear
/// from m0 to m1 (>= 0).
template <class T>
struct AzimuthCell {
  T width, m0, m1;

  /// The a in [0, 1] below which the mass `inside` lies; 0 for a cell without mass. The quadratic (Havran
  /// et al. 2003, eq. 24) in units of m0 + m1, so that neither very small masses underflow nor nearly
  /// equal ones cancel: a = x / (n0 + sqrt(n0^2 + (1 - 2 n0) x)) for the fraction x of the cell's mass.
  T invert(T inside) const noexcept {
    using std::sqrt;
    const T sum = m0 + m1;
    if (!(sum > 0)) return 0;
    const T x = std::clamp(2 * inside / (width * sum), T(0), T(1));
    const T n0 = m0 / sum;
    const T denominator = n0 + sqrt(std::max(n0 * n0 + (1 - 2 * n0) * x, T(0)));
    return denominator > 0 ? std::min(x / denominator, T(1)) : T(0);
  }
};

}  // namespace gonio
