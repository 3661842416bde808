#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gonio/brdf/proof/measure.h>

namespace gonio {

/// The weights of a sampler over the unit square at one incident angle: where its variance sits.
struct WeightMap {
  static constexpr int side = 48;
  std::vector<float> weight;  ///< side x side cells, u-major: luminance weight over the mean one, mean of 4 x 4 points
};

/// @param theta_i [rad].
WeightMap weight_map(const proof::Subject& subject, double theta_i);

/// One row of the figure: a method, with a map and the relative variance for each of report_angles.
struct WeightRow {
  std::string name;
  std::vector<WeightMap> maps;
  std::vector<double> relvar;
};

/// Writes an SVG of the maps: white where the weight is the mean, blue below, red above.
/// @throws Error if it cannot be written.
void write_weights_figure(const std::filesystem::path& path, const std::string& title,
                          const std::vector<WeightRow>& rows);

}  // namespace gonio
