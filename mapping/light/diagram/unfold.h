#pragma once

#include <string>
#include <vector>

#include <gonio/mapping/base/problem.h>
#include <gonio/mapping/light/diagram/light_diagram.h>

namespace gonio {

/// Which meridians a file leaves out because they repeat others.
enum class LightSymmetry {
  none,        ///< all meridians are there (EULUMDAT Isym 0)
  rotational,  ///< one meridian (Isym 1)
  c0_c180,     ///< mirrored at the plane C0-C180: 0 to 180 stored (Isym 2)
  c90_c270,    ///< mirrored at the plane C90-C270: 90 to 270 stored (Isym 3)
  quadrant     ///< mirrored at both: 0 to 90 stored (Isym 4)
};

const char* to_string(LightSymmetry symmetry) noexcept;

/// Intensities as a file lists them, in degrees.
struct FoldedLight {
  std::vector<double> c;      ///< [deg] ascending
  std::vector<double> gamma;  ///< [deg] from the nadir of the frame, ascending, in [0, 180]
  std::vector<double> cd;     ///< c.size() x gamma.size(), in `unit`, finite
  std::string unit = "cd";    ///< for messages
  LightSymmetry symmetry = LightSymmetry::none;
  /// C outside [c.front(), c.back()] is dark instead of being closed to a turn: types A and B.
  bool sector = false;
};

/// One table of mirror images for all formats: repeats the meridians that the symmetry leaves out,
/// closes the turn, adds what is dark outside the measured angles, makes the poles single-valued
/// (mean over C) and negative values zero. Everything that it changes is told in `deviations`.
///
/// Where a distribution ends abruptly (at the last gamma of a file that stops short of 90 or 180,
/// at the edges of a sector) it falls to zero over `edge_width`.
/// @throws Error naming `name` if an angle list is empty, not ascending or out of range.
LightDiagram unfold(const FoldedLight& folded, const LightFrame& frame, const std::string& name, Problems& deviations);

/// Width [rad] of the slope with which an abrupt edge is represented: a thousandth of a degree.
inline constexpr double edge_width = 1e-3 * pi<double> / 180;

/// The strongest symmetry of `diagram` in its own frame, exact up to `tolerance` times I_max, among
/// those whose mirror planes are meridians of the diagram.
LightSymmetry find_symmetry(const LightDiagram& diagram, double tolerance = 1e-7);

/// The inverse of unfold(): the meridians that remain, in degrees. `symmetry` must hold.
FoldedLight fold(const LightDiagram& diagram, LightSymmetry symmetry);

}  // namespace gonio
