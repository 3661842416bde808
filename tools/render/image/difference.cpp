#include "tools/render/image/difference.h"

#include <algorithm>
#include <cmath>

#include <gonio/brdf/table/table.h>

#include "tools/render/image/tone_map.h"

namespace gonio {

RelativeError relative_error(const RgbImage& image, const RgbImage& reference, const std::vector<std::size_t>& pixels) {
  const double n = static_cast<double>(pixels.size());
  double mean = 0, sum = 0, squares = 0;
  for (const std::size_t k : pixels)
    for (int c = 0; c < 3; ++c) mean += static_cast<double>(reference.pixels[k][c]) / (3 * n);
  for (const std::size_t k : pixels) {
    double error = 0;
    for (int c = 0; c < 3; ++c) {
      const double r = static_cast<double>(reference.pixels[k][c]), d = static_cast<double>(image.pixels[k][c]) - r;
      const double scale = r * r + 0.01 * mean * mean;
      if (scale > 0) error += d * d / scale / 3;
    }
    sum += error;
    squares += error * error;
  }
  return {sum / n, std::sqrt(std::max(squares / n - sum / n * (sum / n), 0.0) / (n - 1))};
}

std::string difference_png(const RgbImage& image, const RgbImage& reference) {
  std::vector<unsigned char> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (std::size_t k = 0; k < image.pixels.size(); ++k) {
    const float r = luminance(reference.pixels[k]), d = luminance(image.pixels[k]) - r;
    const float t = std::clamp(d == 0 ? 0.0f : d / (0.5f * std::max(r, 1e-6f)), -1.0f, 1.0f), fade = 1 - std::abs(t);
    const float red = t > 0 ? 1 - 0.3f * t : fade, green = fade, blue = t < 0 ? 1 + 0.3f * t : fade;
    for (const float x : {red, green, blue}) bytes.push_back(static_cast<unsigned char>(std::lround(255 * x)));
  }
  return encode_png(image.width, image.height, bytes);
}

}  // namespace gonio
