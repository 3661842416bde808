#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gonio/mapping/light/files/luminaire.h>

namespace gonio {

struct PolarPlot {
  /// Planes [rad], each drawn with its opposite half: C on the right, C + 180 on the left. The
  /// first with a full line, the second dashed, and so on.
  std::vector<double> planes{0, pi<double> / 2};
  bool per_klm = false;  ///< cd per 1000 lm of the luminaire's flux instead of cd
  std::string title;     ///< empty: the luminaire's name
};

/// The goniometric polar diagram as people in lighting draw it: nadir down, intensity as the
/// distance from the centre, circles with round numbers (the outermost holds I_max of the whole
/// diagram, whatever the planes), rays every 30 degrees; beam and field
/// angles of the planes below. The upper half is drawn only if there is light. Intensities are
/// those of the diagram (bilinear).
/// @throws Error for a dark luminaire, no plane, or more than 4.
std::string polar_svg(const Luminaire& light, const PolarPlot& plot = {});

/// Radius of I = 1 cd (or cd/klm), and the centre, in the units of the picture that polar_svg()
/// draws: for tests and overlays.
struct PolarScale {
  double radius_per_unit, x, y;
};
PolarScale polar_scale(const Luminaire& light, const PolarPlot& plot = {});

}  // namespace gonio
