#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/cell_policies.h>
#include <gonio/brdf/formats/measured_cells.h>
#include <gonio/brdf/formats/rgl/warp2d.h>
#include <gonio/mapping/base/problem.h>

namespace gonio {

/// The content of an isotropic RGL `.bsdf` file (Dupuy and Jakob 2018), checked. All grids hold
/// their values at nodes, the last axis along theta.
struct RglFile {
  /// [slice][height][width], height along phi, width along theta.
  struct Grid {
    int slices = 0, height = 0, width = 0;
    std::vector<float> values;
  };

  std::string description;
  std::vector<float> theta_i;  ///< radians, rising; one slice of vndf, luminance and colour each
  Grid ndf, sigma;             ///< one slice: microfacet density and projected area, as stored
  Grid vndf, luminance;        ///< densities, not normalised, as stored
  int colour_height = 0, colour_width = 0;
  std::vector<glm::vec3> colour;  ///< [slice][height][width], linear Rec. 709
  bool jacobian = true;           ///< colour is to be multiplied by ndf / (4 sigma)
  int n_wavelengths = 0;          ///< of a spectral file, whose spectra were converted; else 0
};

/// Reads an RGL file with colours (`rgb`) or spectra (`spectra`, `wavelengths`; see
/// rec709_weights).
/// @throws Error naming every field at fault. Anisotropic files are refused: more than two phi_i,
/// or two whose data differ.
RglFile read_rgl(const std::filesystem::path& path);

/// The same from bytes in memory; adds to `problems` instead of throwing. Not usable if a fatal
/// problem was found.
RglFile parse_rgl(std::string bytes, Problems& problems);

/// Repairs the values of ndf, sigma, vndf and luminance that are negative or not finite, as CellPolicies
/// says. CellPolicy::fill takes the nearest valid value along theta, else phi, else theta_i.
/// @returns how many values there are and were repaired, in all four together
/// @throws Error under CellPolicy::reject, or if values are to be filled and none is valid, naming the field.
CellCounts repair_densities(RglFile& file, const CellPolicies& policies);

/// An RGL material ready for evaluation, with its own sampling chain.
///
/// The stored colour stands for f_r * cos(theta_o). Colour cells with a negative channel are
/// measurement noise about 0: under CellPolicy::zero they take part in the interpolation, as in the
/// authors' own loader, and the result is clamped to 0. `fill` takes the nearest valid cell along
/// theta, else phi, else theta_i.
class RglTable {
 public:
  /// eval() divides by cos(theta_o), but never by less than this (89.94 degrees): the measured
  /// product need not vanish at the horizon, where f_r would grow without bound.
  static constexpr float min_cosine = 1e-3f;

  struct Sample {
    glm::vec3 wo;
    float pdf;      ///< per solid angle
    glm::vec3 f_r;  ///< eval(wi, wo), up to rounding
  };

  /// Densities are repaired as repair_densities() does.
  /// @throws Error under CellPolicy::reject, or if no colour cell or no density is valid.
  RglTable(RglFile file, const CellPolicies& policies);

  /// f_r in 1/sr. Needs both directions above the horizon.
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// f_r * cos(theta_o), what the file tabulates. Needs both directions above the horizon.
  glm::vec3 eval_cosine(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// The share of eval()'s value that comes from cells which the file has a value for, in [0, 1].
  /// 0 outside the file's incident angles. Needs both directions above the horizon.
  float measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// The format's own sampling: (u1, u2) in [0, 1)^2 through the luminance warp, the vndf warp and
  /// the reflection at the microfacet normal. Nothing if the draw falls below the horizon.
  std::optional<Sample> sample(const glm::vec3& wi, float u1, float u2) const noexcept;

  /// Density of sample() per solid angle; it integrates to a little under 1, by the draws that
  /// fail.
  float pdf(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// The file's own microfacet density at polar angle theta [rad], in 1/sr.
  float ndf(float theta) const noexcept;

  /// The file's own projected area of the microfacets as seen from polar angle theta [rad], 1 at 0.
  float sigma(float theta) const noexcept;

  const CellCounts& cells() const noexcept { return counts_; }

  /// Values of ndf, sigma, vndf and luminance, and how many of them were repaired.
  const CellCounts& densities() const noexcept { return density_counts_; }
  bool spectral() const noexcept { return n_wavelengths_ > 0; }
  const std::vector<float>& theta_i() const noexcept { return theta_i_; }

  /// What vector code reads.
  const RglFile::Grid& ndf_grid() const noexcept { return ndf_; }
  const std::vector<float>& sigma_line() const noexcept { return sigma_; }  ///< along theta, at phi = 0
  const Warp2d& vndf() const noexcept { return vndf_; }
  int colour_height() const noexcept { return colour_height_; }
  int colour_width() const noexcept { return colour_width_; }
  /// [slice][height][width], and a spare one: of each, four floats may be loaded.
  const std::vector<glm::vec3>& colour() const noexcept { return colour_; }
  bool jacobian() const noexcept { return jacobian_; }  ///< colour is to be multiplied by ndf / (4 sigma)

 private:
  struct Normal;  // a microfacet normal in the chart of the file

  Lerp slice_at(float theta) const noexcept;
  Normal half_vector(const glm::vec3& wi, const glm::vec3& wo) const noexcept;
  glm::vec3 colour_at(const Lerp& slice, float x, float y) const noexcept;
  glm::vec3 value_at(const Normal& normal, float theta_i, const Lerp& slice, float x, float y) const noexcept;

  CellCounts density_counts_;
  std::vector<float> theta_i_;
  RglFile::Grid ndf_;
  std::vector<float> sigma_;
  Warp2d vndf_, luminance_;
  int colour_height_, colour_width_;
  std::vector<glm::vec3> colour_;
  bool jacobian_;
  int n_wavelengths_;
  CellCounts counts_;
  MeasuredCells measured_;
};

}  // namespace gonio
