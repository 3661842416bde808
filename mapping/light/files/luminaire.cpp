#include <algorithm>
#include <cmath>

#include <gonio/mapping/base/bytes.h>
#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/files/luminaire.h>
#include <gonio/mapping/light/files/text_scanner.h>

namespace gonio {
namespace {

/// The text of a photometric file.
std::string read_text(const std::filesystem::path& path, Problems& deviations) {
  const std::string bytes = read_bytes(path);
  std::string text = without_utf16(bytes);
  if (text != bytes) deviations.push_back({"encoding", "UTF-16", "ASCII; converted", false});
  return text;
}

/// Factor of the lamp's output at a tilt; angles outside the table take its ends.
double tilt_factor(const IesFile& file, double degrees) {
  const auto& angles = file.tilt_angles;
  if (angles.empty()) return 1;
  if (degrees <= angles.front()) return file.tilt_factors.front();
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (degrees <= angles[i] && angles[i] > angles[i - 1]) {
      const double t = (degrees - angles[i - 1]) / (angles[i] - angles[i - 1]);
      return (1 - t) * file.tilt_factors[i - 1] + t * file.tilt_factors[i];
    }
  return file.tilt_factors.back();
}

/// The symmetry that the range of horizontal angles implies (LM-63-2002, 5.13 and annex; 1995 for
/// 90-270). A range that is turned by whole halves or quadrants implies the same.
LightSymmetry ies_symmetry(const std::vector<double>& horizontal, Problems& deviations) {
  const double first = horizontal.front(), span = horizontal.back() - first;
  const auto is = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  const auto multiple = [&](double angle, double of) { return is(angle, of * std::round(angle / of)); };
  if (horizontal.size() == 1) return LightSymmetry::rotational;
  if (is(span, 90) && multiple(first, 90)) return LightSymmetry::quadrant;
  if (is(span, 180) && multiple(first, 180)) return LightSymmetry::c0_c180;
  if (is(span, 180) && multiple(first, 90)) return LightSymmetry::c90_c270;
  if (is(span, 360)) return LightSymmetry::none;
  deviations.push_back({"horizontal angles", format_number(first) + " to " + format_number(horizontal.back()),
                        "0 to 90, 0 to 180, 90 to 270 or 0 to 360; closed to a full turn by interpolation", false});
  return LightSymmetry::none;
}

/// A symmetry of a file's labels in a frame where its 0-degree plane is the C plane `zero` [rad].
LightSymmetry turned(LightSymmetry symmetry, double zero) {
  if (symmetry == LightSymmetry::rotational) return symmetry;
  const double quarters = zero / (pi<double> / 2);
  if (std::abs(quarters - std::round(quarters)) > 1e-9) return LightSymmetry::none;
  if (std::lround(quarters) % 2 == 0) return symmetry;
  if (symmetry == LightSymmetry::c0_c180) return LightSymmetry::c90_c270;
  return symmetry == LightSymmetry::c90_c270 ? LightSymmetry::c0_c180 : symmetry;
}

/// The luminous opening: sizes across, along and up [m], and whether it is an ellipse seen from
/// below. Negative sizes code round shapes: a circle is -D 0 0 in 1995, -D -D 0 in 2002; with a
/// negative height one positive size is the axis of a horizontal cylinder.
void set_opening(Luminaire& light, const IesFile& file, bool upright) {
  const double metre = file.units == 1 ? 0.3048 : 1.0;
  double across = std::abs(file.width) * metre, along = std::abs(file.length) * metre;
  const double up = std::abs(file.height) * metre;
  const int edition = file.edition();
  const bool cylinder = file.height < 0 && (file.width > 0 || file.length > 0);
  const bool standing =  // a disk that faces the horizon
      file.width < 0 && file.length == 0 && file.height < 0 && (edition == 0 || edition >= 2002);
  light.round = (file.width < 0 || file.length < 0) && !cylinder && !standing;
  if (light.round || cylinder) {
    const double diameter = light.round ? std::max(across, along) : up;
    if (file.width == 0) across = diameter;
    if (file.length == 0) along = diameter;
  }
  light.size = {upright ? across : along, upright ? along : across, up};
}

/// What in a file of type C looks like the labels of EULUMDAT, whose C0 is across the lamp.
std::string other_zero(const IesFile& file, const LightDiagram& as_labelled) {
  if (find_symmetry(as_labelled) == LightSymmetry::c90_c270)
    return "the light is mirrored at the 90-270 plane, not at the 0-180 plane";
  if (file.length > 0 && file.width > 1.5 * file.length)
    return "the opening is longer across the 0-degree plane than along it";
  return {};
}

/// Types A and B: repeats the half that a file with angles from 0 leaves out.
void mirror_to_negative(std::vector<double>& angles, std::vector<double>& cd, bool rows) {
  const std::size_t n = angles.size(), others = cd.size() / n;
  std::vector<double> all;
  for (std::size_t i = n; i-- > 1;) all.push_back(-angles[i]);
  all.insert(all.end(), angles.begin(), angles.end());
  const std::size_t m = all.size();
  std::vector<double> result(m * others);
  for (std::size_t i = 0; i < m; ++i) {
    const std::size_t from = i < n - 1 ? n - 1 - i : i - (n - 1);
    for (std::size_t k = 0; k < others; ++k)
      (rows ? result[i * others + k] : result[k * m + i]) = rows ? cd[from * others + k] : cd[k * n + from];
  }
  angles = std::move(all);
  cd = std::move(result);
}

/// The frame of a type C or A file whose 0-degree plane is the C plane `zero`.
LightFrame ies_frame(double zero, bool clockwise) {
  const LightFrame world;
  LightFrame frame;
  frame.c0 = world.direction(zero, pi<double> / 2);
  frame.c90 = world.direction(zero + (clockwise ? -1 : 1) * pi<double> / 2, pi<double> / 2);
  return frame;
}

/// How much the start of a text looks like an EULUMDAT file.
enum class EulumdatLikeness {
  none,
  numbers,  ///< lines 2 to 4 and 6 are numbers: perhaps damaged
  in_range  ///< and integers that Ityp, Isym, Mc and Ng can have
};

EulumdatLikeness eulumdat_likeness(std::string_view text) {
  struct Limit {
    int line, lowest, highest;
  };
  constexpr Limit limits[] = {{2, 0, 3}, {3, 0, 4}, {4, 1, most_eulumdat_angles}, {6, 2, most_eulumdat_angles}};
  bool in_range = true;
  std::size_t next = 0;
  for (int number = 1; number <= 7; ++number) {
    const std::size_t end = text.find_first_of("\r\n", next);
    if (end == std::string_view::npos) return EulumdatLikeness::none;
    for (const Limit& limit : limits) {
      if (limit.line != number) continue;
      double value;
      if (!parse_number(text.substr(next, end - next), Comma::decimal, value)) return EulumdatLikeness::none;
      in_range = in_range && value == std::floor(value) && value >= limit.lowest && value <= limit.highest;
    }
    next = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
  }
  return in_range ? EulumdatLikeness::in_range : EulumdatLikeness::numbers;
}

}  // namespace

Luminaire to_luminaire(const IesFile& file, const std::string& name, const LightOptions& options,
                       Problems& deviations) {
  Luminaire light;
  static constexpr const char* type_names[] = {"C", "B", "A"};
  light.format = (file.standard.empty() ? std::string("IES LM-63-1986") : "IES " + file.standard) + ", type " +
                 type_names[static_cast<int>(file.type) - 1];
  light.manufacturer = to_utf8(file.keyword("MANUFAC"));
  light.name = to_utf8(file.keyword("LUMINAIRE"));
  light.number = to_utf8(file.keyword("LUMCAT"));
  light.lamp = to_utf8(file.keyword("LAMP"));
  if (const std::string unit = file.keyword("_INTENSITYUNITS"); !unit.empty()) light.unit = to_utf8(unit);
  light.watts = std::max(file.watts, 0.0);
  light.absolute = file.lumens_per_lamp < 0;
  if (file.lumens_per_lamp > 0 && file.lamps > 0) light.lamp_lumens = file.lumens_per_lamp * file.lamps;
  for (const char* key : {"_TOTALLUMINAIRELUMENS", "TOTALLUMINAIRELUMENS"}) {
    const std::string text = file.keyword(key);
    if (double lumens;
        (parse_number(text, Comma::thousands, lumens) || parse_number(text, Comma::decimal, lumens)) && lumens > 0)
      light.stated_lumens = lumens;
  }
  set_opening(light, file, std::abs(std::sin(options.ies_zero)) > 0.5);

  double factor = file.factor();
  if (file.tilt == IesFile::Tilt::file && file.tilt_angles.empty())
    deviations.push_back({"TILT", file.tilt_file, "a file beside this one; taken as NONE", false});
  else if (file.tilt != IesFile::Tilt::none)
    factor *= tilt_factor(file, options.tilt * 180 / pi<double>);
  if (!(factor > 0) || !std::isfinite(factor))
    throw Error(name + ": multiplier, ballast factor: found a product of " + format_number(factor) +
                ", expected a positive number");

  FoldedLight folded;
  folded.cd = file.candela;
  folded.unit = light.unit;
  for (double& v : folded.cd) v *= factor;
  folded.gamma = file.vertical;
  folded.c = file.horizontal;
  LightFrame frame = ies_frame(options.ies_zero, options.clockwise);
  if (file.type == IesFile::Type::c) {
    folded.symmetry = ies_symmetry(folded.c, deviations);
    light.symmetry = turned(folded.symmetry, options.ies_zero);
  } else {
    // Horizontal 0 to 90 means the same on both sides; vertical 0 to 90 likewise.
    if (folded.c.size() > 1 && folded.c.front() == 0) mirror_to_negative(folded.c, folded.cd, true);
    if (folded.gamma.size() > 1 && folded.gamma.front() == 0 && file.type == IesFile::Type::b)
      mirror_to_negative(folded.gamma, folded.cd, false);
    folded.sector = true;
    for (double& v : folded.gamma) v += 90;
    if (file.type == IesFile::Type::a) {
      // Polar axis vertical: V = -90 is the nadir, (0, 0) is horizontal in the 0-degree plane.
      if (folded.c.size() == 1) folded.symmetry = light.symmetry = LightSymmetry::rotational;
    } else {
      // Polar axis horizontal: H is the angle in planes through the axis at H = +-90, V turns the
      // plane about it; (0, 0) is the nadir, (0, V = 90) is horizontal in the 0-degree plane.
      if (folded.c.size() == 1 || folded.gamma.size() == 1)
        throw Error(name + ": type B: found a single angle, expected at least 2 vertical and horizontal ones");
      FoldedLight turned;
      turned.sector = true;
      turned.unit = light.unit;
      turned.c = file.vertical;  // rows become planes V, columns angles H
      if (turned.c.front() == 0) {
        turned.c.clear();
        for (double v : folded.gamma) turned.c.push_back(v - 90);
      }
      for (double h : folded.c) turned.gamma.push_back(h + 90);
      const std::size_t rows = folded.c.size(), columns = folded.gamma.size();
      for (std::size_t v = 0; v < columns; ++v)
        for (std::size_t h = 0; h < rows; ++h) turned.cd.push_back(folded.cd[h * columns + v]);
      folded = std::move(turned);
      frame = {-frame.c90, {0, 0, -1}, frame.c0};
    }
  }
  light.diagram = unfold(folded, frame, name, deviations);
  if (file.type != IesFile::Type::b) light.diagram = in_frame(light.diagram, LightFrame{});
  if (file.type == IesFile::Type::c && options.ies_zero != 0)
    light.other_zero = other_zero(file, in_frame(light.diagram, frame));
  return light;
}

Luminaire to_luminaire(const EulumdatFile& file, const std::string& name, const LightOptions& options,
                       Problems& deviations) {
  Luminaire light;
  light.format = "EULUMDAT";
  light.manufacturer = to_utf8(file.company);
  light.name = to_utf8(file.name);
  light.number = to_utf8(file.number);
  double lumens = 1000;  // cd/klm stay what they are if nothing is stated
  if (!file.lamp_sets.empty()) {
    if (options.lamp_set >= file.lamp_sets.size())
      throw Error(name + ": lamp set " + std::to_string(options.lamp_set) + ": found " +
                  std::to_string(file.lamp_sets.size()) + " sets, numbered from 0");
    const EulumdatFile::LampSet& set = file.lamp_sets[options.lamp_set];
    light.lamp = to_utf8(set.type);
    light.watts = std::max(set.watts, 0.0);
    light.absolute = set.lamps < 0;
    if (set.lumens > 0) {
      lumens = set.lumens;
      light.lamp_lumens = lumens;
      light.stated_lumens = lumens * file.light_output_ratio / 100;
    }
    if (file.lamp_sets.size() > 1)
      deviations.push_back({"lamp sets", std::to_string(file.lamp_sets.size()),
                            "alternatives; set " + std::to_string(options.lamp_set) + " is taken", false});
  }
  if (!light.lamp_lumens) deviations.push_back({"lamp flux", "none", "a positive number; 1000 lm are taken", false});
  light.downward_fraction = file.downward_fraction / 100;
  light.round = file.luminous_width == 0 && file.luminous_length > 0;
  const double y = file.luminous_length / 1000, x = light.round ? y : file.luminous_width / 1000;
  light.size = {x, y, *std::max_element(file.luminous_height.begin(), file.luminous_height.end()) / 1000};

  if (!(file.conversion_factor > 0))
    throw Error(name + ": conversion factor: found " + format_number(file.conversion_factor) +
                ", expected a positive number");
  static constexpr LightSymmetry symmetries[] = {LightSymmetry::none, LightSymmetry::rotational, LightSymmetry::c0_c180,
                                                 LightSymmetry::c90_c270, LightSymmetry::quadrant};
  FoldedLight folded;
  folded.symmetry = light.symmetry = symmetries[file.symmetry];
  folded.c = file.stored_c();
  folded.gamma = file.gamma;
  folded.cd = file.intensity;
  for (double& v : folded.cd) v *= lumens / 1000 * file.conversion_factor;
  LightFrame frame;
  if (options.clockwise) frame.c90 = -frame.c90;
  light.diagram = in_frame(unfold(folded, frame, name, deviations), LightFrame{});
  return light;
}

LightFormat light_format(std::string_view text) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  const EulumdatLikeness likeness = eulumdat_likeness(text);
  if (likeness == EulumdatLikeness::in_range) return LightFormat::eulumdat;
  bool first = true;
  for (std::string_view rest = text; !rest.empty(); first = false) {
    const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
    if (tilt_value(line) || (first && names_ies_standard(line))) return LightFormat::ies;
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  return likeness == EulumdatLikeness::numbers ? LightFormat::eulumdat : LightFormat::unknown;
}

Luminaire load_light(const std::filesystem::path& path, const LightOptions& options, Problems& deviations) {
  const std::string text = read_text(path, deviations), name = path.string();
  switch (light_format(text)) {
    case LightFormat::ies: {
      IesFile file = read_ies(text, name, deviations);
      if (file.tilt == IesFile::Tilt::file) {
        const std::filesystem::path beside = path.parent_path() / std::filesystem::path(file.tilt_file).filename();
        if (std::filesystem::is_regular_file(beside))
          read_ies_tilt(read_text(beside, deviations), beside.string(), file);
      }
      return to_luminaire(file, name, options, deviations);
    }
    case LightFormat::eulumdat:
      return to_luminaire(read_eulumdat(text, name, deviations), name, options, deviations);
    case LightFormat::unknown:
      break;
  }
  throw Error(name +
              ": found neither a line TILT= (IES) nor the numbers of lines 2 to 7 (EULUMDAT), "
              "expected a photometric file");
}

Luminaire load_light(const std::filesystem::path& path, const LightOptions& options) {
  Problems ignored;
  return load_light(path, options, ignored);
}

IesFile to_ies(const Luminaire& light, const LightOptions& options) {
  const LightDiagram diagram = in_frame(light.diagram, ies_frame(options.ies_zero, options.clockwise));
  const LightSymmetry symmetry = find_symmetry(diagram);
  FoldedLight folded = fold(diagram, symmetry);
  IesFile file;
  file.standard = "IESNA:LM-63-2002";
  const auto label = [&](const char* key, const std::string& value) {
    file.labels.push_back("[" + std::string(key) + "] " + (value.empty() ? "unknown" : shortened(value, 120)));
  };
  label("TEST", "");
  label("TESTLAB", "");
  label("ISSUEDATE", "");
  label("MANUFAC", light.manufacturer);
  if (!light.number.empty()) label("LUMCAT", light.number);
  if (!light.name.empty()) label("LUMINAIRE", light.name);
  if (!light.lamp.empty()) label("LAMP", light.lamp);
  if (light.unit != "cd") label("_INTENSITYUNITS", light.unit);
  if (!light.absolute && light.lamp_lumens) file.lumens_per_lamp = *light.lamp_lumens;
  const bool upright = std::abs(std::sin(options.ies_zero)) > 0.5;
  file.width = (light.round ? -1 : 1) * (upright ? light.size.x : light.size.y);
  file.length = (light.round ? -1 : 1) * (upright ? light.size.y : light.size.x);  // 2002: -D -D 0
  file.height = light.size.z;
  file.watts = light.watts;
  file.vertical = folded.gamma;
  file.horizontal = folded.c;
  file.candela = folded.cd;
  return file;
}

namespace {

/// True if programs that find the planes of Isym 3 by index, as mc1 = 3 Mc/4 + 1 says, find C270.
bool holds_from_c270(const LightDiagram& d) {
  Problems none;
  const std::vector<double> c = unfold(fold(d, LightSymmetry::c90_c270), d.frame, "EULUMDAT", none).c;
  const std::size_t mc = c.size() - 1;
  return mc % 2 == 0 && std::abs(c[3 * mc / 4] - 1.5 * pi<double>) < 1e-9;
}

}  // namespace

EulumdatFile to_eulumdat(const Luminaire& light) {
  const LightDiagram full = in_frame(light.diagram, LightFrame{});
  LightSymmetry symmetry = find_symmetry(full);
  if (symmetry == LightSymmetry::c90_c270 && !holds_from_c270(full)) symmetry = LightSymmetry::none;
  const FoldedLight folded = fold(full, symmetry);
  Problems none;
  const LightDiagram diagram = unfold(folded, LightFrame{}, "EULUMDAT", none);  // as a reader will see it
  EulumdatFile file;
  file.company = shortened(light.manufacturer, 78);
  file.name = shortened(light.name, 78);
  file.number = shortened(light.number, 78);
  file.type = symmetry == LightSymmetry::rotational ? 1 : light.size.y > 2 * light.size.x ? 2 : 3;
  static constexpr LightSymmetry order[] = {LightSymmetry::none, LightSymmetry::rotational, LightSymmetry::c0_c180,
                                            LightSymmetry::c90_c270, LightSymmetry::quadrant};
  file.symmetry = static_cast<int>(std::find(std::begin(order), std::end(order), symmetry) - std::begin(order));
  // A width of 0 is a circle; the format has no ellipses.
  const bool circle = light.round && std::abs(light.size.x - light.size.y) <= 1e-6 * light.size.x;
  file.length = file.luminous_length = light.size.y * 1000;
  file.width = file.luminous_width = circle ? 0 : light.size.x * 1000;
  file.height = light.size.z * 1000;
  file.luminous_height.fill(light.size.z * 1000);

  const double total = flux(diagram);
  EulumdatFile::LampSet set;
  set.type = shortened(light.lamp, 78);
  set.watts = light.watts;
  set.lumens = light.lamp_lumens.value_or(light.stated_lumens.value_or(total));
  set.lamps = light.absolute || !light.lamp_lumens ? -1 : 1;
  if (!(set.lumens > 0)) set.lumens = 1000;  // a dark luminaire
  file.light_output_ratio = 100 * total / set.lumens;
  file.downward_fraction = total > 0 ? 100 * flux(diagram, 0, pi<double> / 2) / total : 0;
  const double scale = 1000 / set.lumens;
  file.lamp_sets.push_back(set);

  for (std::size_t i = 0; i + 1 < diagram.c.size(); ++i) file.c.push_back(diagram.c[i] * 180 / pi<double>);
  file.gamma = folded.gamma;
  file.intensity = folded.cd;
  if (symmetry == LightSymmetry::c90_c270) {
    // The format stores C270 to C450; I(270 + k) = I(270 - k), so the planes 270 to 90, reversed.
    const std::size_t n = folded.gamma.size(), m = folded.c.size();
    for (std::size_t i = 0; i < m; ++i)
      std::copy_n(folded.cd.begin() + static_cast<std::ptrdiff_t>((m - 1 - i) * n), n,
                  file.intensity.begin() + static_cast<std::ptrdiff_t>(i * n));
  }
  // Without symmetry fold() keeps the closing meridian; the format has none at 360 degrees.
  if (symmetry == LightSymmetry::none) file.intensity.resize(file.c.size() * file.gamma.size());
  for (double& v : file.intensity) v *= scale;
  const auto step = [](const std::vector<double>& x) {
    if (x.size() < 2) return 0.0;
    const double d = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
    for (std::size_t i = 1; i < x.size(); ++i)
      if (std::abs(x[i] - x[i - 1] - d) > 1e-6) return 0.0;
    return d;
  };
  file.c_step = step(file.c);
  file.g_step = step(file.gamma);
  return file;
}

}  // namespace gonio
