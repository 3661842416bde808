#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace gonio {

/// Pixels row by row from the top, left to right.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<glm::vec3> pixels;
};

/// The channels R, G, B (or Y alone) of an OpenEXR file of any pixel type.
/// @throws Error naming the file if it cannot be read or has neither.
RgbImage load_rgb(const std::filesystem::path& path);

/// Channels of 32-bit floats by name: `prefix`R, `prefix`G, `prefix`B of each layer.
struct ImageLayer {
  std::string prefix;                 ///< "" or "albedo."
  std::vector<std::string> channels;  ///< "R", "G", "B", or "X", "Y", "Z", or one alone
  const RgbImage* image;              ///< the channels take r, g, b in this order
};

/// Writes one OpenEXR file, or leaves `path` as it was. All layers have the size of the first.
/// @throws Error if it cannot be written.
void save_layers(const std::filesystem::path& path, const std::vector<ImageLayer>& layers);

}  // namespace gonio
