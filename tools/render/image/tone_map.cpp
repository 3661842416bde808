#include "tools/render/image/tone_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/common.hpp>
#include <png.h>

#include <gonio/brdf/table/table.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

float srgb_curve(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f; }

}  // namespace

std::string encode_png(int width, int height, const std::vector<unsigned char>& srgb) {
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(width);
  header.height = static_cast<png_uint_32>(height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, srgb.data(), 0, nullptr))
    throw Error(std::string("picture: cannot be compressed: ") + header.message);
  bytes.resize(size);
  return bytes;
}

std::string tone_mapped_png(const RgbImage& image, float exposure) {
  constexpr float white = 4;
  std::vector<unsigned char> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (glm::vec3 p : image.pixels) {
    p *= exposure;
    const float l = luminance(p);
    p = l > 0 && std::isfinite(l) ? p * ((1 + l / (white * white)) / (1 + l)) : glm::vec3(0);
    for (int c = 0; c < 3; ++c)
      bytes.push_back(static_cast<unsigned char>(std::lround(255 * srgb_curve(std::clamp(p[c], 0.0f, 1.0f)))));
  }
  return encode_png(image.width, image.height, bytes);
}

}  // namespace gonio
