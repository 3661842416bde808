#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/cell_policies.h>
#include <gonio/brdf/formats/measured_cells.h>
#include <gonio/mapping/base/problem.h>

namespace gonio {

/// A MERL `.binary` file (Matusik et al. 2003) exactly as stored: header int32 90, 90, n_phi_d,
/// then float64 [channel R, G, B][theta_h][theta_d][phi_d]. Kept in double and unscaled, so that
/// reading and writing gives back the same bytes.
///
/// Cell (i, j, k) is centred at theta_h = (pi/2) ((i + 0.5)/90)^2, theta_d = (j + 0.5) degrees,
/// phi_d = (k + 0.5) degrees: half and difference angles of Rusinkiewicz 1998.
struct MerlFile {
  static constexpr int n_theta_h = 90, n_theta_d = 90;

  int n_phi_d = 180;           ///< 180: phi_d in [0, pi), reciprocal; 360: phi_d in [0, 2 pi)
  std::vector<double> values;  ///< file units: f_r = value * merl_scale[channel]; < 0: not measured

  std::size_t cells() const noexcept {
    return static_cast<std::size_t>(n_theta_h) * n_theta_d * static_cast<std::size_t>(n_phi_d);
  }
};

/// f_r in 1/sr per unit of a stored value, for R, G and B.
inline constexpr double merl_scale[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

/// @throws Error if the file cannot be read, its dimensions are not 90 x 90 x (180 or 360), or its
/// size is not the one they ask for.
MerlFile read_merl(const std::filesystem::path& path);

/// The same from bytes in memory; adds to `problems` instead of throwing. The values are empty if a
/// fatal problem was found.
MerlFile parse_merl(const std::string& bytes, Problems& problems);

/// Writes the file, or leaves `path` untouched and throws Error.
void write_merl(const std::filesystem::path& path, const MerlFile& file);

/// Half and difference angles of a pair of directions, in radians. phi_d is in [-pi, pi] and that
/// of `wi` relative to the half vector's meridian.
struct HalfDifference {
  float theta_h, theta_d, phi_d;
};

/// Rusinkiewicz 1998, from half-chords and atan2: accurate near theta_h = 0 and theta_d = 0, where
/// the usual acos of a dot product loses half its digits. Needs unit vectors in the frame of
/// BrdfTable.
HalfDifference half_difference(const glm::vec3& wi, const glm::vec3& wo) noexcept;

/// The directions whose half vector lies in the plane phi = 0: the inverse of half_difference up to
/// a rotation about the normal. They may lie below the horizon.
void directions_from_half_difference(double theta_h, double theta_d, double phi_d, glm::vec3& wi,
                                     glm::vec3& wo) noexcept;

/// A MERL material ready for evaluation: float RGB cells, repaired.
///
/// A cell with a negative channel counts as missing. Cells whose centre has a direction at or below
/// the horizon hold nothing measured, whatever the file says; they are always filled, so that
/// nothing leaks across the horizon. `fill` takes the nearest valid cell along theta_d, else phi_d,
/// else theta_h.
class MerlTable {
 public:
  /// @throws Error under CellPolicy::reject, or if there is no valid cell or `values` has a wrong
  /// size.
  MerlTable(const MerlFile& file, const CellPolicies& policies);

  /// f_r in 1/sr, trilinear between cell centres, constant beyond the outermost centres of theta_h
  /// and theta_d, periodic in phi_d (period pi for 180 bins: reciprocity; 2 pi for 360). Needs both
  /// directions above the horizon.
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// The share of eval()'s value that comes from cells which the file has a value for, in [0, 1].
  /// Needs both directions above the horizon.
  float measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  const CellCounts& cells() const noexcept { return counts_; }
  int n_phi_d() const noexcept { return n_phi_d_; }

  /// [theta_h][theta_d][phi_d] in 1/sr, and a spare one: of each, four floats may be loaded.
  const std::vector<glm::vec3>& values() const noexcept { return values_; }

 private:
  struct Neighbours;  // between which cells a pair of directions lies

  Neighbours neighbours_of(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  int n_phi_d_;
  std::vector<glm::vec3> values_;
  CellCounts counts_;
  MeasuredCells measured_;
};

}  // namespace gonio
