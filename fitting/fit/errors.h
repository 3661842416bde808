#pragma once

#include <limits>

#include <gonio/fitting/fit/brdf_function.h>
#include <gonio/fitting/fit/fit.h>

namespace gonio {

/// How far a model is from a table, in several measures, since none of them agrees with the eye for
/// all materials. Directions are integrated over the hemispheres of wi and wo with their solid
/// angles, as far as the table was measured. NaN where no pair was.
struct FitErrors {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  /// Root of the mean of ((f_model - f_table) cos_o)^2 over pairs and channels [1/sr].
  double cosine_rms = none;
  /// Root of the mean of log((f_model cos_o + e) / (f_table cos_o + e))^2, e = 1e-3/sr. 0.1 is
  /// about 10 %.
  double log_rms = none;
  /// Integral of |f_model - f_table| cos_o cos_i over that of f_table cos_o cos_i; 0.1 is 10 % of
  /// the light. NaN if the table is black.
  double relative_l1 = none;
  /// Largest difference of the directional albedos over channels and all incident angles up to
  /// last_albedo_angle; where wo was measured in part, of the light reflected there.
  double albedo = none;
  /// Mean CIEDE2000 over the pixels of a sphere: orthographic view, three distant lights at 10, 50
  /// and 90 degrees from the viewer, one after the other, each of irradiance pi, so that a white
  /// Lambert surface facing the light is (1, 1, 1); clipped there.
  double delta_e = none;
};

/// The same apart for directions a fit looks at and those beyond its cut-off.
struct FitErrorReport {
  FitErrors inside;  ///< wi and wo within the cut-off (albedo: wi)
  FitErrors beyond;  ///< either beyond it
};

/// Radians; at 90 degrees nothing is reflected any more.
inline constexpr double last_albedo_angle = 89.9 * pi<double> / 180;

/// @param table NaN where it was not measured, as measured_part() is
/// @param cutoff radians from the normal
FitErrorReport fit_errors(const BrdfFunction& table, const BrdfFunction& model, double cutoff = default_grazing_cutoff);

}  // namespace gonio
