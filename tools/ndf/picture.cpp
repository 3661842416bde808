#include "tools/ndf/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <ostream>

#include <png.h>

#include <gonio/mapping/base/atomic_file.h>
#include <gonio/mapping/base/error.h>

#include "tools/cli/number.h"
#include "tools/page/base64.h"

namespace gonio {
namespace {

constexpr double degree = pi<double> / 180;

using Rgb = std::array<double, 3>;

/// Dark blue over green to yellow: lightness rises evenly, also without colours.
Rgb colour(double t) {
  static constexpr std::array<Rgb, 6> stops{
      {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
  const double at = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  Rgb result;
  for (std::size_t c = 0; c < 3; ++c)
    result[c] = stops[k][c] + (at - static_cast<double>(k)) * (stops[k + 1][c] - stops[k][c]);
  return result;
}

double stretched(double value, const Contrast& c) {
  if (c.logarithmic) return value > 0 ? std::log(value / c.low) / std::log(c.high / c.low) : 0;
  return (value - c.low) / (c.high - c.low);
}

std::string png(const DiskImage& image, const Contrast& contrast) {
  std::vector<png_byte> pixels;
  pixels.reserve(4 * image.values.size());
  for (int row = 0; row < image.size; ++row)
    for (int column = 0; column < image.size; ++column) {
      Vec3<double> w;
      const bool inside = pixel_direction(image.size, row, column, w);
      const Rgb rgb = colour(stretched(static_cast<double>(image.at(row, column)), contrast));
      for (const double c : rgb) pixels.push_back(static_cast<png_byte>(std::lround(c)));
      pixels.push_back(inside ? 255 : 0);
    }
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  header.width = header.height = static_cast<png_uint_32>(image.size);
  header.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, pixels.data(), 0, nullptr))
    throw Error(std::string("picture: cannot be compressed: ") + header.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace

Contrast ndf_contrast(const DiskImage& ndf) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const float value : ndf.values) {
    if (!(value > 0)) continue;
    low = std::min(low, static_cast<double>(value));
    high = std::max(high, static_cast<double>(value));
  }
  low = std::max(low, high * 1e-4);
  return {low < high ? low : high / 2, high, true};  // one value: any range shows it
}

Contrast g1_contrast(const DiskImage& g1) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (int row = 0; row < g1.size; ++row)
    for (int column = 0; column < g1.size; ++column) {
      Vec3<double> w;
      if (!pixel_direction(g1.size, row, column, w)) continue;
      const double value = static_cast<double>(g1.at(row, column));
      high = std::max(high, value);
      if (w.z >= std::cos(80 * degree)) low = std::min(low, value);
    }
  return {low < high * (1 - 1e-6) ? low : high - 1e-3, high, false};
}

void write_disk_picture(const std::filesystem::path& path, const DiskImage& image, const Contrast& contrast,
                        const std::string& title, const std::string& unit) {
  constexpr double side = 512, left = 30, top = 70, bar = left + side + 40;
  write_stream_atomically(path, [&](std::ostream& out) {
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 740 "
           "610\" "
           "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"740\" height=\"610\" fill=\"white\"/>\n"
           "<text x=\"30\" y=\"28\" font-size=\"17\">";
    for (const char c : title) c == '&' ? out << "&amp;" : c == '<' ? out << "&lt;" : out << c;
    out << "</text>\n<text x=\"30\" y=\"50\" fill=\"#555\">from above, x to the right, y up; contrast stretched "
        << (contrast.logarithmic ? "logarithmically" : "linearly") << " from " << number(contrast.low) << " to "
        << number(contrast.high) << unit << "</text>\n<image x=\"" << left << "\" y=\"" << top << "\" width=\"" << side
        << "\" height=\"" << side << "\" xlink:href=\"data:image/png;base64," << base64(png(image, contrast))
        << "\"/>\n";
    const double cx = left + side / 2, cy = top + side / 2;
    for (const int t : {30, 60, 80}) {
      const double r = side / 2 * std::sin(t * degree);
      out << "<circle cx=\"" << cx << "\" cy=\"" << cy << "\" r=\"" << r
          << "\" fill=\"none\" stroke=\"white\" stroke-opacity=\"0.6\" "
          << "stroke-width=\"0.8\" stroke-dasharray=\"3 4\"/>\n<text x=\"" << cx << "\" y=\"" << cy - r + 13
          << "\" text-anchor=\"middle\" font-size=\"11\" fill=\"white\" stroke=\"#222\" stroke-width=\"2.5\" "
             "paint-order=\"stroke\">"
          << t << "&#176;</text>\n";
    }
    out << "<circle cx=\"" << cx << "\" cy=\"" << cy << "\" r=\"" << side / 2 << "\" fill=\"none\" stroke=\"#222\"/>\n";
    constexpr int steps = 64;
    for (int k = 0; k < steps; ++k) {
      const Rgb c = colour((k + 0.5) / steps);
      out << "<rect x=\"" << bar << "\" y=\"" << top + side * (steps - 1 - k) / steps << "\" width=\"24\" height=\""
          << side / steps + 0.5 << "\" fill=\"rgb(" << static_cast<int>(c[0]) << ',' << static_cast<int>(c[1]) << ','
          << static_cast<int>(c[2]) << ")\"/>\n";
    }
    constexpr int labels = 5;
    for (int k = 0; k < labels; ++k) {
      const double t = k / (labels - 1.0);
      const double value = contrast.logarithmic ? contrast.low * std::pow(contrast.high / contrast.low, t)
                                                : contrast.low + t * (contrast.high - contrast.low);
      out << "<text x=\"" << bar + 32 << "\" y=\""
          << top + side * (1 - t) +
                 (k == labels - 1 ? 10
                  : k == 0        ? 0
                                  : 5)
          << "\">" << (k == 0 ? "&#8804; " : "") << number(value) << unit << "</text>\n";
    }
    out << "</svg>\n";
  });
}

}  // namespace gonio
