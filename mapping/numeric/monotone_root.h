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

/// At most this many evaluations in monotone_root(): every second one at least halves the bracket or the
/// step, and both end at the rounding of T.
inline constexpr int max_root_steps = 2 * 64;

/// The zero in [lo, hi] of a non-decreasing function: Newton steps from `start`, with bisection wherever a step
/// leaves the bracket or is more than half as long as the one before the last. Ends with a step that is
/// rounding of x. A function that jumps over 0 gives the place of the jump. @param start in [lo, hi]; lo >= 0.
template <class T, class Function>
T monotone_root(const Function& function, T start, T lo, T hi) noexcept {
  constexpr T rounding = 2 * std::numeric_limits<T>::epsilon();
  T x = start, last = hi - lo, before_last = last;
  for (int step = 0; step < max_root_steps; ++step) {
    const Slope<T> f = function(x);
    if (f.value == 0) return x;
    (f.value > 0 ? hi : lo) = x;
    T next = x - f.value / std::max(f.derivative, std::numeric_limits<T>::min());  // far away where the slope is 0
    if (!(next >= lo && next <= hi && std::abs(next - x) <= before_last / 2)) next = lo + (hi - lo) / 2;
    before_last = last, last = std::abs(next - x);
    x = next;
    if (!(last > rounding * x)) break;
  }
  return x;
}

}  // namespace gonio
