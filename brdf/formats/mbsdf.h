#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include <gonio/brdf/formats/cell_policies.h>
#include <gonio/brdf/formats/measured_cells.h>
#include <gonio/mapping/base/problem.h>

namespace gonio {

/// A regular grid over theta_in, theta_out in [0, pi/2] and phi in [0, pi], phi relative to the
/// azimuth of `wi` (specular at pi): the layout of NVIDIA's MBSDF files. Value (i, j, k) stands for
/// the centre of its cell: theta_in = (i + 0.5) (pi/2) / n_theta_in, and so on.
struct MbsdfFile {
  int n_theta_in = 0, n_theta_out = 0, n_phi = 0;
  int channels = 3;               ///< 1 or 3 (RGB)
  std::vector<float> values;      ///< f_r in 1/sr, [theta_in][theta_out][phi][channel]
  std::string description;        ///< header lines of the file
  bool has_transmission = false;  ///< the file also had a transmission part, which is not read
};

/// Most thetas or phis that a grid may have.
inline constexpr int max_grid_side = 1 << 14;

/// Reads the reflection part of an MBSDF file, scalar or RGB. Transmission is skipped.
/// @throws Error if the file cannot be read, is damaged, or holds no reflection.
MbsdfFile read_mbsdf(const std::filesystem::path& path);

/// The same from bytes in memory; adds to `problems` instead of throwing. The values are empty if a
/// fatal problem was found.
MbsdfFile parse_mbsdf(const std::string& bytes, Problems& problems);

/// Writes an MBSDF file with reflection alone, or leaves `path` untouched and throws Error. The
/// format has one number of thetas: n_theta_in and n_theta_out must agree.
void write_mbsdf(const std::filesystem::path& path, const MbsdfFile& file);

/// A grid ready for evaluation. `fill` takes the nearest valid cell along phi, else theta_out, else
/// theta_in.
class MbsdfTable {
 public:
  /// @throws Error if a size is < 1, the number of values does not fit, under CellPolicy::reject,
  /// or if there is no valid cell.
  explicit MbsdfTable(const MbsdfFile& file, const CellPolicies& policies = {});

  /// f_r in 1/sr, trilinear between cell centres, constant beyond the outermost ones, mirrored in
  /// phi. Needs both directions above the horizon.
  glm::vec3 eval(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  /// The share of eval()'s value that comes from cells which the file has a value for, in [0, 1].
  /// Needs both directions above the horizon.
  float measured(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  const CellCounts& cells() const noexcept { return counts_; }

  /// The file also had a transmission part, which eval() knows nothing of.
  bool has_transmission() const noexcept { return has_transmission_; }
  int n_theta_in() const noexcept { return n_theta_in_; }
  int n_theta_out() const noexcept { return n_theta_out_; }
  int n_phi() const noexcept { return n_phi_; }

  /// [theta_in][theta_out][phi] in 1/sr, a scalar file three times the same, and a spare one: of each, four floats may
  /// be loaded.
  const std::vector<glm::vec3>& values() const noexcept { return values_; }

 private:
  struct Neighbours;  // between which cells a pair of directions lies

  Neighbours neighbours_of(const glm::vec3& wi, const glm::vec3& wo) const noexcept;

  int n_theta_in_, n_theta_out_, n_phi_;
  std::vector<glm::vec3> values_;
  CellCounts counts_;
  bool has_transmission_;
  MeasuredCells measured_;
};

}  // namespace gonio
