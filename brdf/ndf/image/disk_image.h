#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <gonio/mapping/charts/hemisphere.h>

namespace gonio {

/// A square image of the upper hemisphere flattened orthographically onto the disk of the plane
/// z = 0, the disk filling the image. Row 0 is the top, y = +1; column 0 is the left, x = -1. Pixels
/// that the circle cuts hold the mean over their part within; those outside are 0 and not read.
///
/// As a normal distribution the values are D in 1/sr, each the mean over its pixel with respect to
/// area, which is that with respect to cos(theta) d omega.
struct DiskImage {
  int size = 0;               ///< pixels along a side
  std::vector<float> values;  ///< [row][column]

  DiskImage() = default;
  explicit DiskImage(int side) : size(side), values(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

  float& at(int row, int column) { return values[index(row, column)]; }
  float at(int row, int column) const { return values[index(row, column)]; }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size) + static_cast<std::size_t>(column);
  }
};

inline constexpr int max_disk_image_side = 1 << 13;

/// A pixel on the plane z = 0: what orthographic_solid_angle() takes.
struct PixelBounds {
  double x0, x1, y0, y1;
};
PixelBounds pixel_bounds(int size, int row, int column) noexcept;

/// The direction over the centre of a pixel. False, and w untouched, if the centre is not within the
/// disk.
bool pixel_direction(int size, int row, int column, Vec3<double>& w) noexcept;

/// The image of a distribution that is known at every direction, by 7 x 7 Gauss points in each pixel
/// (16 x 16 points where the circle cuts it). `density` is called from several threads.
/// @throws Error unless size is 1 to max_disk_image_side
DiskImage rasterise(int size, const std::function<double(const Vec3<double>&)>& density);

/// The integral of D cos(theta) d omega, 1 for a normal distribution: the sum of D times area.
double projected_area(const DiskImage& ndf);

/// The integral of D d omega: area of the microsurface per area of the surface, at least the above.
double microsurface_area(const DiskImage& ndf);

/// Medians of the slopes |h.x| / h.z and |h.y| / h.z with respect to D cos(theta) d omega. For GGX they
/// are alpha / sqrt(3) along each axis, for Beckmann 0.4769 alpha. Resolved to about a pixel.
struct MedianSlopes {
  double x, y;
};
MedianSlopes median_slopes(const DiskImage& ndf);

/// Scales the image so that projected_area() is 1 and clears the pixels outside the disk.
/// @return projected_area() before
/// @throws Error if a pixel within the disk is negative or not finite, or if all are 0
double normalise(DiskImage& ndf);

}  // namespace gonio
