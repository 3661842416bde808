#pragma once

#include <filesystem>
#include <string>

#include <gonio/brdf/ndf/image/disk_image.h>

namespace gonio {

/// Writes the image as an OpenEXR file: one channel Y of type FLOAT, row 0 at the top, and the
/// attribute gonio:quantity, such as "D" or "G1".
/// @throws Error if it cannot be written; `path` is then as it was.
void save_disk_image(const std::filesystem::path& path, const DiskImage& image, const std::string& quantity);

/// Reads the image of a normal distribution: channel Y, or else the Rec. 709 luminance of R, G and B,
/// of any OpenEXR pixel type. Values are as stored: see normalise().
/// @throws Error if the file cannot be read, is damaged, is not square, is a stack file, has neither
///   channels, or its gonio:quantity is there and not "D".
DiskImage load_ndf_image(const std::filesystem::path& path);

}  // namespace gonio
