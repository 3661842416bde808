#pragma once

#include <array>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <gonio/mapping/base/problem.h>

namespace gonio {

/// The most planes, and the most gamma angles, that read_eulumdat() takes: what an IES file can
/// have, and the dark ones that are put around them.
inline constexpr int most_eulumdat_angles = 10004;

/// An EULUMDAT file (.ldt) as it stands, field by field: nothing scaled or unfolded.
struct EulumdatFile {
  /// One of the alternative equipments of a luminaire.
  struct LampSet {
    int lamps = 1;  ///< negative: absolute photometry
    std::string type;
    double lumens = 0;  ///< of all lamps together [lm]
    std::string colour;
    std::string rendering;
    double watts = 0;  ///< including ballast
  };

  std::string company;
  int type = 3;       ///< Ityp: 1 point source symmetric about the vertical axis, 2 linear, 3 other
                      ///< point source
  int symmetry = 0;   ///< Isym: 0 none, 1 rotational, 2 C0-C180, 3 C90-C270, 4 both
  double c_step = 0;  ///< Dc [deg]; 0: uneven
  double g_step = 0;  ///< Dg [deg]; 0: uneven
  std::string report, name, number, file_name, date;
  double length = 0, width = 0, height = 0;        ///< luminaire [mm]; width 0: round
  double luminous_length = 0, luminous_width = 0;  ///< luminous area [mm]
  std::array<double, 4> luminous_height{};         ///< at C0, C90, C180, C270 [mm]
  double downward_fraction = 0;                    ///< DFF [%]
  double light_output_ratio = 100;                 ///< LORL [%]
  double conversion_factor = 1;                    ///< of the intensities
  double tilt = 0;                                 ///< during measurement [deg]
  std::vector<LampSet> lamp_sets;
  std::array<double, 10> direct_ratios{};

  std::vector<double> c;          ///< the Mc planes as listed [deg]
  std::vector<double> gamma;      ///< [deg]
  std::vector<double> intensity;  ///< stored planes x gamma.size(), [cd/klm]

  /// The C of the planes whose intensities the file holds [deg], in their order. They are found by
  /// angle: with Isym 3 they run from 270 through 360 to 450 (the standard's mc1 = 3 Mc/4 + 1);
  /// reading them as 90 to 270 would turn the luminaire round. Where all listed planes lie in the
  /// other half (or quadrant), that is the one which is stored.
  std::vector<double> stored_c() const;
};

/// Parses the text of a file: one field a line, any line ends. A comma is the decimal point, unless
/// the file has points too and all its commas can be those of thousands. A file that lists the
/// stored planes only is taken so; one that stores all planes in spite of its Isym gets Isym 0.
/// @param name of the file, for messages.
/// @throws Error naming line and field if it is not such a file: text where a number belongs,
///   counts out of range, other intensities than the planes have, planes out of order.
EulumdatFile read_eulumdat(std::string_view text, const std::string& name, Problems& deviations);

/// Writes `file`; numbers have seven digits.
void write_eulumdat(std::ostream& stream, const EulumdatFile& file);

}  // namespace gonio
