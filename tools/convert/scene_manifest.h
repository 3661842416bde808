#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gonio {

/// A material of a scene and the part it plays in the picture.
struct SceneMaterial {
  std::string name;            ///< also of the files made for it
  std::filesystem::path file;  ///< what load_input() reads
  double share;                ///< of the shaded points, >= 0; the shares of a scene add up to 1
  /// Shares of equal bins of theta_i over [0, pi/2], the sum is 1; empty if unknown.
  std::vector<double> incidence;
};

/// Reads a scene manifest (JSON, docs/guide/scene.md): at least one material. Shares and histograms come out
/// normalised, paths relative to the folder of the manifest.
/// @throws Error naming the file and the field for anything missing, out of range or unknown.
std::vector<SceneMaterial> load_scene(const std::filesystem::path& path);

}  // namespace gonio
