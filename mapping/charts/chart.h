#pragma once

#include <gonio/mapping/charts/concentric.h>
#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

/// What the disk of a diagram stands for.
enum class Chart {
  outgoing,  ///< the hemisphere of outgoing directions, flattened: r = sqrt(1 - cos theta_o), phi of wo
  half       ///< the half vectors that reflect wi to directions above the horizon; see HalfVectorChart
};

inline constexpr Chart charts[] = {Chart::outgoing, Chart::half};
inline const char* to_string(Chart chart) noexcept { return chart == Chart::half ? "half" : "outgoing"; }

template <class T>
struct DirectionSample {
  Vec3<T> wo;  ///< unit, wo.z > 0, phi relative to the azimuth of wi
  T pdf;       ///< per solid angle [1/sr]; 0 where the density vanishes
};

/// What inverting the map of a stack gives.
template <class T>
struct SquareInverse {
  SquarePoint<T> at;  ///< the (u, v) that sample() maps to the direction
  T pdf;              ///< of the direction, per solid angle [1/sr], > 0
};

}  // namespace gonio
