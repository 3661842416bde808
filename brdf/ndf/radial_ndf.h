#pragma once

#include <functional>
#include <vector>

#include <gonio/brdf/table/table.h>

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

/// How masking and shadowing of a facet go together where both directions are the same: G2(k, k).
enum class Masking {
  full,               ///< G1(k): what is seen is lit, as on surfaces
  height_correlated,  ///< 1 / (2 / G1(k) - 1): Smith's with one height for both, as in the lobes of
                      ///< LobeModel and in pbrt
  independent         ///< G1(k)^2: the product of two Smith terms, as in Mitsuba
};

const char* to_string(Masking masking) noexcept;

/// What extract_ndf() found.
struct ExtractedNdf {
  RadialNdf ndf;       ///< normalised
  Masking masking;     ///< assumed, or recognised
  double measured_to;  ///< [rad] beyond it D is a continuation
  int iterations;      ///< of the power method
  double change;       ///< largest relative change of D in the last one
};

/// The normal distribution of an isotropic material from its retro-reflection: f_r(k, k) [1/sr] at
/// polar angle theta in [0, 89 degrees], NaN where it was not measured. Dupuy, Heitz, Iehl, Poulin and
/// Ostromoukhov 2015, "Extracting microfacet-based BRDF parameters from arbitrary materials with power
/// iterations": a microfacet material has f_r(k, k) = F(0) D(k) G2(k, k) / (4 cos^2), G1 = cos / sigma,
/// whence for full masking (their eq. 6)
///
///   D(k) ~ f_r(k, k) cos(theta_k) integral of max(k . h, 0) D(h) d omega_h:
///
/// D is the eigenvector of a kernel with values >= 0, which power iteration finds from any start. The
/// other maskings have a factor of sigma that is of the first degree in D as well. A diffuse part of the
/// material counts as wide facets, as in the paper. Beyond the last known angle D goes on as a GGX
/// does, 1 / sqrt(D) linear in cos^2; between known angles it is linear, before the first constant.
/// @throws Error if there is no retro-reflection
ExtractedNdf extract_ndf(const std::function<double(double theta)>& retro_reflection, Masking masking = Masking::full,
                         int nodes = 512);

/// The same from the luminance of a table, where it was measured, to 75 degrees. The masking is the one of
/// the three with which D agrees best with the table between directions that differ: full, as on
/// surfaces, unless another is twice as near.
/// @throws Error if the table has no retro-reflection
ExtractedNdf extract_ndf(const BrdfTable& table, int nodes = 512);

}  // namespace gonio
