#pragma once

#include <string>

#include "tools/render/image/exr_image.h"

namespace gonio {

/// Radiance as sRGB bytes: luminance L becomes L (1 + L / w^2) / (1 + L) with w = 4 (Reinhard et al.,
/// "Photographic Tone Reproduction for Digital Images", 2002, eq. 4), which leaves hues as they are;
/// then the curve of IEC 61966-2-1. Values that are not finite are black.
/// @return the bytes of a PNG file. @throws Error if it cannot be compressed.
std::string tone_mapped_png(const RgbImage& image, float exposure = 1);

/// A PNG of sRGB bytes as they are, three a pixel.
std::string encode_png(int width, int height, const std::vector<unsigned char>& srgb);

}  // namespace gonio
