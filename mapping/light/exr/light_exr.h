#pragma once

#include <filesystem>
#include <string>

#include <gonio/mapping/light/files/luminaire.h>
#include <gonio/mapping/light/texture/solid.h>

namespace gonio {

/// Version of the layout that save_light() writes; load_light_exr() reads this one only.
inline constexpr int light_exr_version = 1;

/// Writes a luminaire as an OpenEXR file of this library: channel "cd" (32-bit float), a row per
/// meridian, a column per parallel; attributes gonioLight (the version), c and gamma (lines [deg]),
/// the frame, and what the file said about the luminaire. A type B diagram keeps its own frame. Here
/// and below, a file at `path` is replaced as a whole or left as it was.
/// @throws Error if the path cannot be written.
void save_light(const std::filesystem::path& path, const Luminaire& light);

/// @throws Error naming the attribute if the file is not such a file, is damaged, or of another
/// version.
Luminaire load_light_exr(const std::filesystem::path& path);

/// True if the content is that of a file that load_any_light() reads, whole or not.
/// @throws Error if the file cannot be read.
bool is_light_file(const std::filesystem::path& path);

/// load_light() for all formats: IES, EULUMDAT and the EXR of this library, told by content.
Luminaire load_any_light(const std::filesystem::path& path, const LightOptions& options, Problems& deviations);

/// Images of the whole sphere for renderers, channel "Y" (32-bit float, [cd]). A pixel holds the
/// mean intensity over its solid angle (4 x 4 points), so the sum over the pixels keeps the flux.

/// The equal-area octahedral map of octahedral.h, resolution x resolution: +z (the zenith) in the
/// centre, the nadir in the corners. What pbrt-v4's goniometric light reads.
/// @throws Error for a resolution below 8 or a path that cannot be written.
void save_octahedral(const std::filesystem::path& path, const Reconstruction& intensity, int resolution = 512);

/// Latitude-longitude, 2 height x height: the zenith at the top, C from 0 at the left edge to 2 pi
/// at the right.
void save_latlong(const std::filesystem::path& path, const Reconstruction& intensity, int height = 512);

/// A light source for a pbrt-v4 scene whose image is a file of save_octahedral(). In the light's
/// frame as pbrt sees it the zenith is +y, C0 is +x and C90 is +z; both are the same luminaire, not
/// its mirror image, since pbrt's space is left-handed. Intensities are those of the image: [cd].
std::string pbrt_goniometric_light(const std::string& image);

}  // namespace gonio
