#pragma once

#include <cstdint>

#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/formats/merl.h>
#include <gonio/fitting/model/model.h>

namespace gonio {

/// What separates a synthetic table from its model.
struct SynthOptions {
  /// Standard deviation of the multiplicative noise: each cell and channel is multiplied by
  /// max(0, 1 + noise_sigma n), n independent standard normal. 0 is noise-free.
  double noise_sigma = 0;
  std::uint32_t seed = 1;  ///< of the noise; the same seed gives the same table on every platform

  /// Cells where either direction is beyond this angle (radians) are marked as not measured, as
  /// they are near grazing in real tables. The default keeps all of the hemisphere.
  double measured_to = 2;
};

/// The model in the layout of a MERL `.binary`, 180 phi_d bins, evaluated at the centres of the
/// cells; -1 where a direction is below the horizon or not measured.
MerlFile synthesize_merl(const LobeModel& model, const SynthOptions& options = {});

/// The model on a regular grid (the layout of MBSDF), RGB, evaluated at the centres of the cells;
/// NaN where not measured. A lobe narrower than a cell is not resolved: 90 x 90 x 180 has cells of
/// one degree.
/// @throws Error if n_theta or n_phi is less than 2.
MbsdfFile synthesize_mbsdf(const LobeModel& model, int n_theta = 90, int n_phi = 180, const SynthOptions& options = {});

}  // namespace gonio
