#pragma once

#include <filesystem>

#include <gonio/brdf/formats/rgl/rgl.h>

namespace gonio {

/// What an RGL file says of colour beside the densities.
enum class RglColour {
  rgb,             ///< `rgb` alone: what Mitsuba 3 needs in its RGB variants
  rgb_and_spectra  ///< also `spectra` at `wavelengths` (rgb_spectra()): what pbrt-v4 and Mitsuba 3 in its
                   ///< spectral variants need; the RGB variants refuse a file with them
};

/// Writes an isotropic RGL file, replacing the target as a whole or leaving it as it was. Colours, ndf
/// and sigma are those of `stored` bit by bit, but densities that are negative or not finite are repaired as
/// RglTable does by default. Slices of vndf and luminance are scaled to an integral of 1 where they lack it,
/// as readers do themselves. Spectra are of the colours as RglTable repairs them by
/// default, without negative values. phi_i is 0.
///
/// The file has every field, in type and shape, that the authors' loaders (powitacq, powitacq_rgb),
/// pbrt-v4 (MeasuredBxDF) and Mitsuba 3 (measured) ask for.
/// @throws Error if the path cannot be written; if spectra are wanted and no colour is finite; and if
///   luminance and colours are not squares of one size, or jacobian is false, since those readers refuse
///   the one and pbrt-v4 ignores the other.
void write_rgl(const std::filesystem::path& path, const RglFile& stored, RglColour colour = RglColour::rgb_and_spectra);

}  // namespace gonio
