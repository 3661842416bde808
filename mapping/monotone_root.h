#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio {

/// The value and slope of a function at a point.
template <class T>
struct Slope {
  T value, derivative;
};

/// At most this many evaluations in monotone_root(); bisection alone needs one per bit of T.
inline constexpr int max_root_steps = 80;

/// The x in [lo, hi] where a non-decreasing function reaches `target`, by Newton steps kept inside
/// the bracket, with bisection wherever a step leaves it or the bracket fails to halve in two steps.
/// Stops when the value is within `tolerance` of the target or the bracket is down to rounding. A
/// function that jumps over the target gives the place of the jump.
template <class T, class Function>
T monotone_root(const Function& function, T target, T lo, T hi, T tolerance) noexcept {
  T x = lo + (hi - lo) / 2;
  T last_width = hi - lo;
  for (int step = 0; step < max_root_steps; ++step) {
    const Slope<T> f = function(x);
    const T error = f.value - target;
    if (std::abs(error) <= tolerance) return x;
    (error > 0 ? hi : lo) = x;
    const T width = hi - lo;
    if (!(width > std::numeric_limits<T>::epsilon() * hi)) return x;
    T next = f.derivative > 0 ? x - error / f.derivative : lo;
    const bool slow = step % 2 == 1 && width > last_width / 2;
    if (step % 2 == 1) last_width = width;
    if (slow || !(next > lo && next < hi)) next = lo + width / 2;
    if (next == x) return x;
    x = next;
  }
  return x;
}

}  // namespace gonio
