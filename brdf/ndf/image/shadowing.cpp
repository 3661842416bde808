#include <algorithm>
#include <cmath>

#include <gonio/brdf/ndf/image/shadowing.h>
#include <gonio/brdf/ndf/image/solid_angle.h>
#include <gonio/mapping/base/parallel.h>

namespace gonio {
namespace {

constexpr int half_turn = 256;  // azimuths from 0 to pi; the other half turn reads them backwards
constexpr int bins = 2048;

/// Rises with the angle from the horizon at -u over the pole to the horizon at +u; in [0, bins].
double bin_of(double u, double z) noexcept { return bins * 0.5 * (1 + u / (std::abs(u) + z)); }

}  // namespace

Shadowing::Shadowing(const DiskImage& ndf) {
  for (int row = 0; row < ndf.size; ++row)
    for (int column = 0; column < ndf.size; ++column) {
      const double d = static_cast<double>(ndf.at(row, column));
      if (!(d > 0)) continue;
      const PixelBounds p = pixel_bounds(ndf.size, row, column);
      const Vec3<double> facet = d * orthographic_normal_integral(p.x0, p.x1, p.y0, p.y1);
      if (facet.z > 0) facets_.push_back(facet);
    }
  constexpr std::size_t lines = bins + 1;
  sums_.resize(half_turn * lines);
  parallel_for(half_turn, [&](std::size_t azimuth) {
    const double phi = pi<double> * static_cast<double>(azimuth) / half_turn;
    const double cos_phi = std::cos(phi), sin_phi = std::sin(phi);
    Sums* const line = sums_.data() + azimuth * lines;
    for (const Vec3<double>& f : facets_) {
      const double u = cos_phi * f.x + sin_phi * f.y;
      Sums& bin = line[1 + std::min(static_cast<int>(bin_of(u, f.z)), bins - 1)];
      bin.u += u;
      bin.z += f.z;
    }
    for (std::size_t k = 1; k < lines; ++k) {
      line[k].u += line[k - 1].u;
      line[k].z += line[k - 1].z;
    }
  });
}

double Shadowing::sigma_direct(const Vec3<double>& k) const noexcept {
  double sum = 0;
  for (const Vec3<double>& f : facets_) sum += std::max(k.x * f.x + k.y * f.y + k.z * f.z, 0.0);
  return sum;
}

/// `azimuth` in [0, 2 half_turn); k = (sine, cosine) in the plane (u, z) of that azimuth.
double Shadowing::sigma_at(int azimuth, double sine, double cosine) const noexcept {
  const bool backwards = azimuth >= half_turn;
  const Sums* line = sums_.data() + static_cast<std::size_t>(backwards ? azimuth - half_turn : azimuth) * (bins + 1);
  // Facets face k from the bin of the direction at a right angle to it, (-cosine, sine).
  const double at = backwards ? bin_of(cosine, sine) : bin_of(-cosine, sine);
  const int bin = std::min(static_cast<int>(at), bins - 1);
  const double t = at - bin;
  const double u = line[bin].u + t * (line[bin + 1].u - line[bin].u),
               z = line[bin].z + t * (line[bin + 1].z - line[bin].z);
  return backwards ? cosine * z - sine * u : sine * (line[bins].u - u) + cosine * (line[bins].z - z);
}

double Shadowing::sigma(const Vec3<double>& k) const noexcept {
  const double sine = std::hypot(k.x, k.y), turn = std::atan2(k.y, k.x) / pi<double> * half_turn;
  const double floor = std::floor(turn), t = turn - floor;
  const int azimuth = (static_cast<int>(floor) + 2 * half_turn) % (2 * half_turn);
  return (1 - t) * sigma_at(azimuth, sine, k.z) + t * sigma_at((azimuth + 1) % (2 * half_turn), sine, k.z);
}

double Shadowing::g1(const Vec3<double>& k) const noexcept {
  const double area = sigma(k);
  return area > 0 ? k.z / area : 0;
}

DiskImage g1_image(const Shadowing& shadowing, int size) {
  DiskImage image(size);
  parallel_for(static_cast<std::size_t>(size), [&](std::size_t row) {
    for (int column = 0; column < size; ++column) {
      Vec3<double> k;
      if (pixel_direction(size, static_cast<int>(row), column, k))
        image.at(static_cast<int>(row), column) = static_cast<float>(shadowing.g1(k));
    }
  });
  return image;
}

}  // namespace gonio
