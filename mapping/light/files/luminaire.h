#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <gonio/mapping/light/diagram/unfold.h>
#include <gonio/mapping/light/files/eulumdat.h>
#include <gonio/mapping/light/files/ies.h>

namespace gonio {

/// A luminaire: its intensity distribution in the library's frame, and what its file says about it.
///
/// The frame: nadir -z, C0 +x, C90 +y (C turns counter-clockwise seen from above). C0 is that of
/// CIE and EULUMDAT, across the lamp axis. The 0-degree plane of IES files lies along the lamp
/// axis: it is C90 here (see docs/guide/lights.md, with a picture).
struct Luminaire {
  LightDiagram diagram;  ///< [cd]
  /// As the file states it, in this frame: the planes are not the file's labels.
  LightSymmetry symmetry = LightSymmetry::none;
  std::string format;  ///< "IES" or "EULUMDAT" or "EXR", with version and photometric type
  std::string manufacturer, name, number, lamp;
  std::string unit = "cd";                  ///< of the intensities; some files hold radiometric values, say mW/sr
  bool absolute = false;                    ///< absolute photometry: lamp_lumens, if set, is that of the luminaire
  std::optional<double> lamp_lumens;        ///< all lamps together [lm]
  std::optional<double> stated_lumens;      ///< luminous flux of the luminaire as the file states it [lm]
  std::optional<double> downward_fraction;  ///< as the file states it, 0 to 1
  double watts = 0;                         ///< 0: unknown
  Vec3<double> size{0, 0, 0};               ///< luminous opening along x, y, z [m]; 0: point
  bool round = false;                       ///< the opening is an ellipse of x by y, a circle where they are equal
  /// What in an IES file looks as if its 0-degree plane were C0 (LightOptions::ies_zero = 0), as
  /// words for people; empty if nothing does.
  std::string other_zero;
};

/// What a file does not say, or says wrongly.
struct LightOptions {
  /// Horizontal angles run clockwise seen from above. Every third file of type B in circulation
  /// does so without a mark; the default is counter-clockwise for all types.
  bool clockwise = false;
  /// The C plane [rad] that the 0-degree plane of an IES file is. 0 leaves its labels as they are.
  double ies_zero = pi<double> / 2;
  /// Tilt of the lamp [rad] for TILT=INCLUDE and `TILT=<file>`: the output is multiplied by the
  /// factor there.
  double tilt = 0;
  std::size_t lamp_set = 0;  ///< of an EULUMDAT file with several
};

/// The meaning of a parsed file. @param name for messages. @throws Error if angles or values cannot
/// be used, or the lamp set does not exist.
Luminaire to_luminaire(const IesFile& file, const std::string& name, const LightOptions& options, Problems& deviations);
Luminaire to_luminaire(const EulumdatFile& file, const std::string& name, const LightOptions& options,
                       Problems& deviations);

enum class LightFormat { unknown, ies, eulumdat };

/// Told by content: EULUMDAT files have the numbers of lines 2 to 7, IES files a line that begins
/// with TILT= or a first line that names their standard. UTF-16 must be converted before
/// (without_utf16()).
LightFormat light_format(std::string_view text);

/// Reads an IES or EULUMDAT file, told by content, in ASCII, UTF-8 or UTF-16. A TILT file is looked
/// for beside it.
/// @throws Error naming the file if it cannot be read, is neither, or is broken.
Luminaire load_light(const std::filesystem::path& path, const LightOptions& options, Problems& deviations);
Luminaire load_light(const std::filesystem::path& path, const LightOptions& options = {});

/// The luminaire as an LM-63-2002 file of type C, with the strongest symmetry that holds. Absolute
/// photometry (lumens -1) unless the flux of the lamps is known. A diagram whose polar axis is not
/// vertical (type B) is tabulated anew every half degree.
IesFile to_ies(const Luminaire& light, const LightOptions& options = {});

/// The luminaire as an EULUMDAT file, with the strongest symmetry that holds and whose planes other
/// programs find by index as well; without symmetry where they would not. Intensities are per 1000
/// lm of the lamps, or, where these are unknown, of the luminaire (absolute photometry, number of
/// lamps -1). Direct ratios are left 0.
EulumdatFile to_eulumdat(const Luminaire& light);

}  // namespace gonio
