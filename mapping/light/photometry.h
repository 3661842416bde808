#pragma once

#include <vector>

#include <gonio/mapping/light/files/luminaire.h>

namespace gonio {

/// What lighting people ask of a luminaire. All angles in radians, in the library's frame.
struct Photometry {
  double flux;           ///< [lm]
  double downward_flux;  ///< below the horizontal [lm]
  double max_cd;         ///< I_max [cd]
  LightAngles max_at;    ///< where; C = 0 at a pole
  /// Angles of a plane through the vertical axis: the smallest arc that holds every direction of
  /// the plane with at least half (beam) or a tenth (field) of the plane's own maximum; 0 for a
  /// dark plane.
  struct Spread {
    double beam, field;
  };
  Spread c0, c90;             ///< of the planes C0-C180 and C90-C270
  std::vector<double> zones;  ///< zonal lumens, 18 zones of 10 degrees of gamma from the nadir [lm]
};

/// Exact for the bilinear diagram, if its polar axis is vertical; of others flux and maximum are
/// exact, and the rest is that of the diagram tabulated every half degree.
Photometry photometry(const LightDiagram& diagram);

/// Light output ratio: flux of the luminaire over that of its lamps; unset if that is unknown or
/// the photometry is absolute.
std::optional<double> light_output_ratio(const Luminaire& light);
/// The unit of fluxes: "lm" for intensities in cd, of radiometric files that of their own
/// intensities without "/sr".
std::string flux_unit(const Luminaire& light);
/// Luminous efficacy [lm/W]: flux over input power; unset if that is unknown.
std::optional<double> efficacy(const Luminaire& light);

/// How intensities are scaled before use. Nothing in the library scales unless asked.
enum class LightNormalisation {
  none,    ///< cd as measured
  flux,    ///< so that the flux is 1 lm (times a given target)
  maximum  ///< so that I_max is 1 cd (times a given target)
};

/// @throws Error for a dark diagram in the modes flux and maximum.
LightDiagram normalised(LightDiagram diagram, LightNormalisation mode, double target = 1);

}  // namespace gonio
