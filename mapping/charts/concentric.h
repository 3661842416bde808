#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <gonio/mapping/numeric/fast_math.h>
#include <gonio/mapping/numeric/pi.h>

namespace gonio {

/// A point of the unit square; both coordinates in [0, 1].
template <class T>
struct SquarePoint {
  T u, v;
};

/// A point of the unit disk in polar form, as the two uniform numbers that the following maps use:
/// `turn` = phi_B / 2 pi in [0, 1) and `r2` = r_B^2 in [0, 1]. `rest` is 1 - r2: next to the rim it has
/// digits that r2 has not.
template <class T>
struct DiskPoint {
  T turn, r2, rest = 1 - r2;
};

/// M_B: the concentric map of Shirley and Chiu (1997) from the unit square to the unit disk, area
/// preserving and bicontinuous, with phi_B in [0, 2 pi) as Havran et al. (2003, section 3.1) ask
/// instead of the original [-pi/4, 7 pi/4).
///
/// Polar by construction: one division, no trigonometry, and r_B^2 is exact for exact inputs. `rest` has a
/// relative error of at most 2 epsilon, down to u or v = 0.
/// @param u,v in [0, 1]. Other values give a point outside the disk.
template <class T>
DiskPoint<T> square_to_disk(T u, T v) noexcept {
  const T x = 2 * u - 1, y = 2 * v - 1;
  const T ax = std::abs(x), ay = std::abs(y), radius = std::max(ax, ay);
  const T part = std::min(ax, ay) / std::max(radius, std::numeric_limits<T>::min()) / 8;
  T turn = select(ax > ay, part, T(0.25) - part);  // in the first quadrant
  turn = select(x < 0, T(0.5) - turn, turn);
  turn = select(y < 0, 1 - turn, turn);
  const T to_rim = 2 * std::min(std::min(u, 1 - u), std::min(v, 1 - v));          // 1 - radius, without its rounding
  return {select(turn < 1, turn, T(0)), radius * radius, to_rim * (2 - to_rim)};  // a turn that rounds to 1 is 0 again
}

/// The inverse of square_to_disk(). @param p turn in [0, 1), r2 in [0, 1]; `rest` is not looked at.
template <class T>
SquarePoint<T> disk_to_square(DiskPoint<T> p) noexcept {
  const T radius = std::sqrt(p.r2);
  const T octant = 8 * p.turn;  // in units of pi/4; the x axis is at 0 and 8
  T x, y;
  if (octant < 1) {
    x = radius, y = radius * octant;
  } else if (octant < 3) {
    x = radius * (2 - octant), y = radius;
  } else if (octant < 5) {
    x = -radius, y = radius * (4 - octant);
  } else if (octant < 7) {
    x = radius * (octant - 6), y = -radius;
  } else {
    x = radius, y = radius * (octant - 8);
  }
  return {std::clamp((x + 1) / 2, T(0), T(1)), std::clamp((y + 1) / 2, T(0), T(1))};
}

}  // namespace gonio
