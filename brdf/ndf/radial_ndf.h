#pragma once

#include <gonio/brdf/table.h>

#include <functional>
#include <vector>

namespace gonio {

/// A rotationally symmetric normal distribution D(theta) in 1/sr, from `nodes` values at
/// theta = (pi/2) u^2, u = 0 ... 1 in equal steps (as close together at the pole as tables need them),
/// linear in u between. The integrals are by four Gauss points between nodes.
///
/// Immutable but for normalise(); const members may be called from several threads.
class RadialNdf {
 public:
  /// @param density at theta in [0, pi/2], >= 0 and finite; @throws Error otherwise, or if nodes < 2
  RadialNdf(int nodes, const std::function<double(double theta)>& density);

  double eval(double theta) const noexcept;

  /// The integral of D cos(theta) d omega.
  double projected_area() const noexcept;

  /// Makes projected_area() 1. @return what it was. @throws Error if it was 0
  double normalise();

  /// Projected area of the microsurface as seen from polar angle theta: the integral of
  /// max(k . h, 0) D(h) d omega_h, that over azimuth in closed form. O(nodes).
  double sigma(double theta) const noexcept;

  /// cos(theta) / sigma(theta).
  double g1(double theta) const noexcept;

  /// theta below which half of D cos(theta) d omega lies: atan(alpha) for GGX.
  double median_theta() const noexcept;

  const std::vector<double>& values() const noexcept { return values_; }

 private:
  std::vector<double> values_;
};

/// What extract_ndf() found.
struct ExtractedNdf {
  RadialNdf ndf;   ///< normalised
  int iterations;  ///< of the power method
  double change;   ///< largest relative change of D in the last one
};

/// The normal distribution of a measured isotropic table from its retro-reflection alone: Dupuy,
/// Heitz, Iehl, Poulin and Ostromoukhov 2015, "Extracting microfacet-based BRDF parameters from
/// arbitrary materials with power iterations". For a microfacet material
/// f_r(k, k) = F(0) D(k) G1(k) / (4 cos^2), G1 = cos / sigma, whence (their eq. 6)
///
///   D(k) ~ f_r(k, k) cos(theta_k) integral of max(k . h, 0) D(h) d omega_h:
///
/// D is the eigenvector of a kernel with values >= 0, which power iteration finds from any start. Uses
/// luminance. A diffuse part of the material counts as wide facets, as in the paper. Beyond 89
/// degrees, where tables end, f_r cos is held constant.
/// @throws Error if the table has no retro-reflection
ExtractedNdf extract_ndf(const BrdfTable& table, int nodes = 512);

/// The same from retro-reflection given as a function: f_r(k, k) at polar angle theta < 90 degrees.
ExtractedNdf extract_ndf(const std::function<double(double theta)>& retro_reflection, int nodes = 512);

}  // namespace gonio
