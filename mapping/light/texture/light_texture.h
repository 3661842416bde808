#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <gonio/mapping/light/diagram/light_diagram.h>

namespace gonio {

/// How a light distribution texture is reconstructed between its texels (Wallner 2008,
/// section 4.1). The numbers are those of the GLSL include.
enum class LightFilter {
  bilinear = 0,
  catmull_rom = 1,  ///< interpolates, smooth
  mitchell = 2,     ///< Mitchell-Netravali, B = C = 1/3: smooths a little, does not interpolate
  bspline = 3       ///< cubic B-spline on prefiltered coefficients: interpolates, smoothest
};

/// The four weights of a cubic (or linear) filter at fraction t in [0, 1) between taps 1 and 2.
std::array<float, 4> filter_weights(LightFilter filter, float t) noexcept;

/// A light distribution texture (LDT): the intensities of a luminaire over I_max on an even grid,
/// made for the graphics card, with the same lookup as mapping/light/glsl/ldt.glsl.
///
/// Texel (j, i) with j in [1, n_gamma] and i in [0, m_c) lies at gamma = gamma_from + (j - 1)
/// gamma_step and C = 2 pi i / m_c: values belong to texel centres, the lines of the file. m_c is 1
/// for a rotationally symmetric luminaire, a texture of one dimension; a luminaire that lights one
/// hemisphere has texels there alone.
///
/// Columns 0 and n_gamma + 1 are a border, so that a filter needs no special case: beyond a pole
/// the meridian goes on at C + 180 degrees, beyond the horizon of a hemispherical texture it is
/// mirrored. For the filter that smooths, the border at a pole is 2 mean(first ring) - first ring
/// instead: the pole keeps one value, whatever the meridian that it is approached on.
///
/// Corrections to the paper: eq. 3 lacks the normalisation of the projected vector that its Listing
/// 1 has; the axis that repeats is t (C), not s; texture coordinates must hit texel centres, which
/// eqs. 1 and 2 ignore; atan2 replaces arc cosines, which lose half of the digits next to the axis.
///
/// Thread safety: immutable; concurrent use is safe.
class LightTexture {
 public:
  /// Even diagrams keep their lines as texels. Uneven ones are tabulated from their bilinear
  /// interpolation on the coarsest even grid that has all lines among its own, at most
  /// `most_cells` a turn (half as many from pole to pole); then on that finest one.
  /// @throws Error as check(), and if the diagram is dark everywhere.
  LightTexture(const LightDiagram& diagram, LightFilter filter, int most_cells = 1440);

  /// The intensity over I_max in direction `w` of space, a unit vector; 0 in the dark hemisphere. At
  /// least 0; filters that overshoot may exceed 1.
  float lookup(const Vec3<float>& w) const noexcept;
  /// lookup() times I_max [cd].
  double intensity(const Vec3<double>& direction) const noexcept {
    return max_cd_ * double(lookup(Vec3<float>(direction)));
  }

  int n_gamma() const noexcept { return n_gamma_; }
  int m_c() const noexcept { return m_c_; }
  /// Texels of a row with the border: n_gamma() + 2.
  int width() const noexcept { return n_gamma_ + 2; }
  float gamma_from() const noexcept { return gamma_from_; }
  float gamma_step() const noexcept { return gamma_step_; }
  double max_cd() const noexcept { return max_cd_; }
  LightFilter filter() const noexcept { return filter_; }
  const LightFrame& frame() const noexcept { return frame_; }
  /// m_c() rows of width() texels, what is uploaded; B-spline coefficients for that filter.
  const std::vector<float>& texels() const noexcept { return texels_; }

 private:
  int n_gamma_, m_c_;
  float gamma_from_, gamma_step_;
  double max_cd_;
  LightFilter filter_;
  LightFrame frame_;
  Vec3<float> nadir_, c0_, c90_;
  std::vector<float> texels_;
};

/// The law of the point light (Wallner 2008, eq. 4): illuminance [lx] at right angles to the light,
/// B = I LDT(theta, phi) / d^2, at the point `offset` [m] from the light. @param intensity I [cd]:
/// max_cd() for the luminaire as measured, other values dim it.
float point_light(const LightTexture& texture, float intensity, const Vec3<float>& offset) noexcept;

/// The intensity [cd] that two perpendicular planes of a diagram, C0-C180 and C90-C270, imply in
/// any direction `w`: it is projected onto both planes, and between the two intensities
/// found there an ellipse with these semi-axes is followed (Languenou and Tellier 1992, as
/// described by Wallner 2008, section 3): I = sqrt(I0^2 cos^2 C + I1^2 sin^2 C). Exact on the two
/// planes; a rotationally symmetric luminaire is not reproduced exactly between them.
double two_plane_intensity(const LightDiagram& diagram, const Vec3<double>& w) noexcept;

}  // namespace gonio
