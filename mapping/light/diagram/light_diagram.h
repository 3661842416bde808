#pragma once

#include <cstddef>
#include <vector>

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

/// How the angles of a light diagram lie in space: three perpendicular unit vectors.
/// gamma is measured from `nadir`; C turns from `c0` towards `c90`. Left-handed frames (C clockwise
/// seen from above) are allowed.
struct LightFrame {
  Vec3<double> nadir{0, 0, -1}, c0{1, 0, 0}, c90{0, 1, 0};

  Vec3<double> direction(double c, double gamma) const noexcept;
};

/// A direction in the angles of a frame: C in [0, 2 pi), gamma in [0, pi].
struct LightAngles {
  double c, gamma;
};

/// Accurate next to the poles too. @param w a unit vector (any length but zero is accepted).
LightAngles to_light_angles(const LightFrame& frame, const Vec3<double>& w) noexcept;

/// A luminous intensity distribution: a full goniometric diagram, symmetries unfolded, on irregular
/// meridians (C planes) and parallels (gamma). Between its lines the intensity is bilinear in C and
/// gamma; where gamma is not covered it is 0.
struct LightDiagram {
  std::vector<double> c;      ///< M >= 2 meridians [rad], ascending from 0 to 2 pi; the last repeats the first
  std::vector<double> gamma;  ///< N >= 2 parallels [rad], ascending from 0 or pi/2 to pi/2 or pi
  std::vector<double> cd;     ///< M x N intensities [cd], meridian-major, finite, >= 0; where meridians meet at a
                              ///< pole they hold one value (but for the dark ones of a sector)
  LightFrame frame;

  double& at(std::size_t meridian, std::size_t parallel) { return cd[meridian * gamma.size() + parallel]; }
  double at(std::size_t meridian, std::size_t parallel) const { return cd[meridian * gamma.size() + parallel]; }
  /// Intensity at angles of this diagram's own frame; C of any turn, gamma in [0, pi].
  double intensity(LightAngles angles) const noexcept;
  /// Intensity [cd] in a direction of space, a unit vector.
  double intensity(const Vec3<double>& direction) const noexcept;
  /// True if all meridians are equal and only the first and last are stored.
  bool rotational() const noexcept { return c.size() == 2; }
};

/// @throws Error naming the field if `diagram` breaks what the members above state.
void check(const LightDiagram& diagram);

/// The largest stored value [cd].
double max_intensity(const LightDiagram& diagram) noexcept;

/// The flux [lm] of the bilinear diagram between two values of gamma [rad], in closed form:
/// integral of I sin(gamma) dgamma dC. Accurate to rounding.
double flux(const LightDiagram& diagram, double gamma_from = 0, double gamma_to = pi<double>) noexcept;

/// The same distribution without the parallels of a hemisphere that is dark throughout: what costs
/// half. A diagram that is zero everywhere keeps its lower half.
LightDiagram without_dark_hemisphere(const LightDiagram& diagram);

/// The same distribution in another frame. Exact (bit by bit up to the C labels) if both frames
/// share the polar axis and its direction; otherwise tabulated anew every `step` [rad] (a divisor
/// of pi/2).
LightDiagram in_frame(const LightDiagram& diagram, const LightFrame& frame, double step = pi<double> / 360);

/// The same distribution with parallels [rad] inserted where they are missing; exact.
LightDiagram with_parallel(const LightDiagram& diagram, double gamma);

}  // namespace gonio
