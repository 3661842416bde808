#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gonio/brdf/ndf/radial_ndf.h>

namespace gonio {

/// A curve of the figure.
struct NdfProfile {
  std::string name, colour, dashes;
  RadialNdf ndf;
};

/// Writes an SVG figure of rotationally symmetric distributions: D over theta, both axes stretched, and
/// G1 over theta. The first profile sets the range. @throws Error if it cannot be written
void write_ndf_profiles(const std::filesystem::path& path, const std::string& title,
                        const std::vector<NdfProfile>& profiles);

}  // namespace gonio
