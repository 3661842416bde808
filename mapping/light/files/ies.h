#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <gonio/mapping/base/problem.h>

namespace gonio {

/// An IES LM-63 file (1986, 1991, 1995, 2002, 2019) as it stands: nothing scaled, unfolded or
/// rotated.
struct IesFile {
  enum class Tilt { none, include, file };
  enum class Type { c = 1, b = 2, a = 3 };

  std::string standard;             ///< first line, such as "IESNA:LM-63-2002"; empty for LM-63-1986
  std::vector<std::string> labels;  ///< lines between the first and TILT=, keywords and all

  Tilt tilt = Tilt::none;
  std::string tilt_file;             ///< name, for Tilt::file
  int lamp_to_luminaire = 1;         ///< 1 to 3, with the factors below
  std::vector<double> tilt_angles;   ///< [deg]
  std::vector<double> tilt_factors;  ///< of the lamp's output

  int lamps = 1;
  double lumens_per_lamp = -1;  ///< [lm]; negative: absolute photometry
  double multiplier = 1;        ///< of all intensities
  Type type = Type::c;
  int units = 2;  ///< of the three sizes: 1 feet, 2 metres
  double width = 0, length = 0,
         height = 0;  ///< luminous opening; negative values code round shapes
  double ballast_factor = 1;
  /// Ballast-lamp photometric factor in 1986 and 1991, "future use" in 1995 and 2002, file
  /// generation type in 2019.
  double second_factor = 1;
  double watts = 0;

  std::vector<double> vertical;    ///< [deg]
  std::vector<double> horizontal;  ///< [deg]
  std::vector<double> candela;     ///< horizontal.size() x vertical.size(), before the factors

  /// The year of the standard that the first line names, in whatever spelling: 1986, 1991, 1995,
  /// 2002 or 2019; 1986 if it names none, 0 if it names another.
  int edition() const;
  /// What every stored intensity is multiplied by: multiplier, ballast factor and, where the
  /// standard means it as a factor (1986 and 1991), the second one. TILT is not included.
  double factor() const;
  /// The text after "[keyword] ", continued by [MORE] lines; empty if there is none. Capitals and
  /// small letters are the same.
  std::string keyword(std::string_view name) const;
};

/// True if `line`, the first of a file, names a standard: "IESNA:LM-63-2002" in any spelling.
bool names_ies_standard(std::string_view line);
/// What follows "TILT=" if `line` begins so, blanks and small letters allowed.
std::optional<std::string_view> tilt_value(std::string_view line);

/// Parses the text of a file. Tolerated, with a deviation where the standard has it otherwise: byte
/// order mark, any line ends, numbers spread over lines at will, text after the last number,
/// unknown first lines, small letters. Commas between digits are separators, as the standard has
/// them, thousands or decimal points: the first of these with which the counts come out.
/// @param name of the file, for messages.
/// @throws Error naming line and field if it is not such a file: a missing TILT=, text where a
///   number belongs, too few or too many numbers, counts out of range.
IesFile read_ies(std::string_view text, const std::string& name, Problems& deviations);

/// Parses the contents of the file that `TILT=<name>` refers to into the tilt fields of `file`.
/// @throws Error as read_ies().
void read_ies_tilt(std::string_view text, const std::string& name, IesFile& file);

/// Writes `file` with its labels; lines are shorter than 132 characters, numbers have seven digits.
void write_ies(std::ostream& stream, const IesFile& file);

}  // namespace gonio
