#pragma once

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <png.h>

namespace gonio::test {

/// The sRGB bytes of a PNG file, red first, row by row.
inline std::vector<std::array<int, 3>> png_pixels(const std::string& file) {
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&header, file.data(), file.size())) throw std::runtime_error(header.message);
  header.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> bytes(PNG_IMAGE_SIZE(header));
  if (!png_image_finish_read(&header, nullptr, bytes.data(), 0, nullptr)) throw std::runtime_error(header.message);
  std::vector<std::array<int, 3>> pixels(bytes.size() / 3);
  for (std::size_t k = 0; k < bytes.size(); ++k) pixels[k / 3][k % 3] = bytes[k];
  return pixels;
}

}  // namespace gonio::test
