#pragma once

#include <algorithm>
#include <vector>

#include <gonio/mapping/charts/chart.h>
#include <gonio/mapping/charts/concentric.h>
#include <gonio/mapping/charts/half_vector.h>
#include <gonio/mapping/charts/polar_map.h>
#include <gonio/mapping/numeric/find_cell.h>

// What stacks in every storage share: the way from the disk of M_B to a diagram's two uniform numbers, and
// from a diagram's disk to directions. Half diagrams serve phi < 0 as the mirror image of phi > 0: the lower
// half of the disk folds onto the upper.

namespace gonio {

/// A turn about the disk as the first uniform number of a diagram.
template <class T>
struct Folded {
  T u;
  bool mirrored;
};

template <class T>
Folded<T> fold(T turn, bool half) noexcept {
  if (!half) return {turn, false};
  return {2 * std::min(turn, 1 - turn), turn > T(0.5)};
}

template <class T>
T unfold(T u, bool mirrored, bool half) noexcept {
  if (!half) return u < 1 ? u : T(0);
  const T turn = mirrored && u > 0 ? 1 - u / 2 : u / 2;
  return turn < 1 ? turn : T(0);
}

/// A direction on the disk: at.phi folded into the stored azimuth; densities of the disk over those
/// per solid angle.
template <class T>
struct OnDisk {
  Polar<T> at;
  bool mirrored;
  T jacobian;
};

template <class T>
OnDisk<T> to_disk(Chart chart, bool half, T theta_i, const Vec3<T>& wo) noexcept {
  OnDisk<T> d{{}, false, 1};
  if (chart == Chart::outgoing) {
    d.at = direction_to_polar(wo);
  } else {
    const auto point = HalfVectorChart<T>(theta_i).disk(wo);
    d.at = point.at, d.jacobian = point.jacobian;
  }
  d.at.gap = std::max(least_gap<T>, d.at.gap);
  d.mirrored = half && d.at.phi < 0;
  if (d.at.phi < 0) d.at.phi = half ? -d.at.phi : d.at.phi + 2 * pi<T>;
  return d;
}

/// The direction of a draw of a diagram.
template <class T>
DirectionSample<T> from_disk(Chart chart, T theta_i, PolarSample<T> s, bool mirrored) noexcept {
  s.at.phi = select(mirrored, -s.at.phi, s.at.phi);
  if (chart == Chart::outgoing) return {polar_to_direction(s.at), s.pdf};
  const auto d = HalfVectorChart<T>(theta_i).direction(s.at);
  return {d.wo, s.pdf / d.jacobian};
}

/// Where an incident angle lies among `count` ascending ones: `alpha` of the way from k to the next. Beyond
/// both ends alpha is 0 or 1; it is 0 for a single angle.
template <class T>
struct Bracket {
  int k;
  T alpha;
};

template <class T>
Bracket<T> bracket(const std::vector<T>& angles, T theta_i) noexcept {
  const int count = static_cast<int>(angles.size());
  if (count == 1) return {0, 0};
  const int k = find_cell(angles.data(), count, theta_i);
  return {k, std::clamp((theta_i - angles[k]) / (angles[k + 1] - angles[k]), T(0), T(1))};
}

}  // namespace gonio
