#pragma once

#include <gonio/fitting/model.h>

#include <cstdint>
#include <filesystem>
#include <vector>

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

/// The number of doubles in a MERL table: 3 x 90 x 90 x 180.
inline constexpr std::size_t kMerlCells = std::size_t{3} * 90 * 90 * 180;

/// The model in the layout of a MERL `.binary`: file units (f_r 1500/1, 1500/1.15, 1500/1.66),
/// evaluated at the centres of the cells; -1 where a direction is below the horizon or not
/// measured.
std::vector<double> synthesize_merl(const LobeModel& model, const SynthOptions& options = {});

/// Writes synthesize_merl() as a MERL `.binary` file (34,992,012 bytes).
/// @throws Error if the file cannot be written.
void save_merl(const std::filesystem::path& path, const LobeModel& model,
               const SynthOptions& options = {});

}  // namespace gonio
