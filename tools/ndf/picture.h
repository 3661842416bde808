#pragma once

#include <filesystem>
#include <string>

#include <gonio/brdf/ndf/image/disk_image.h>

namespace gonio {

/// How values become colours: `low` and all below dark blue, `high` and all above yellow.
struct Contrast {
  double low, high;
  bool logarithmic;
};

/// For a normal distribution: logarithmic, from the peak down to a ten-thousandth of it, or to the
/// lowest value if that is higher.
Contrast ndf_contrast(const DiskImage& ndf);

/// For G1: linear, from the lowest value within 80 degrees, where most of the image's change is, to the
/// highest.
Contrast g1_contrast(const DiskImage& g1);

/// An SVG page: the image as an embedded PNG with rings at 30, 60 and 80 degrees, and a bar that
/// labels the stretched range. @throws Error if it cannot be written
void write_disk_picture(const std::filesystem::path& path, const DiskImage& image, const Contrast& contrast,
                        const std::string& title, const std::string& unit);

}  // namespace gonio
