#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/render/image/exr_image.h"

namespace gonio {

struct RelativeError {
  double relmse;
  double standard_error;  ///< of relmse, from its spread over the pixels: a few fireflies make it large
};

/// Relative mean squared error over some pixels: the mean over pixels and channels of
/// (x - r)^2 / (r^2 + 0.01 m^2) with m the mean of the reference r over those pixels.
/// @param pixels indices, at least two
RelativeError relative_error(const RgbImage& image, const RgbImage& reference, const std::vector<std::size_t>& pixels);

/// Where an image is too bright (red) or too dark (blue), as a PNG: full colour where luminances
/// differ by half of the reference; white where they agree.
std::string difference_png(const RgbImage& image, const RgbImage& reference);

}  // namespace gonio
