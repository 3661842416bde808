#include <gonio/mapping/error.h>
#include <gonio/mapping/light/luminaire.h>
#include <gonio/mapping/light/text_scanner.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace gonio {
namespace {

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(path.string() + ": cannot be opened");
  if (std::filesystem::is_directory(path))  // its stream opens, and throws what names no file
    throw Error(path.string() + ": found a folder, expected a file");
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) throw Error(path.string() + ": cannot be read");
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
/// 90-270).
LightSymmetry ies_symmetry(const std::vector<double>& horizontal, Deviations& deviations) {
  const auto is = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  const double first = horizontal.front(), last = horizontal.back();
  if (horizontal.size() == 1) return LightSymmetry::rotational;
  if (is(first, 0) && is(last, 90)) return LightSymmetry::quadrant;
  if (is(first, 0) && is(last, 180)) return LightSymmetry::c0_c180;
  if ((is(first, 90) && is(last, 270)) || (is(first, -90) && is(last, 90)))
    return LightSymmetry::c90_c270;
  if (is(last - first, 360)) return LightSymmetry::none;
  deviations.push_back(
      {0, "horizontal angles", format_number(first) + " to " + format_number(last),
       "0 to 90, 0 to 180, 90 to 270 or 0 to 360; closed to a full turn by interpolation"});
  return LightSymmetry::none;
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
      (rows ? result[i * others + k] : result[k * m + i]) =
          rows ? cd[from * others + k] : cd[k * n + from];
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

}  // namespace

Luminaire to_luminaire(const IesFile& file, const std::string& name, const LightOptions& options,
                       Deviations& deviations) {
  Luminaire light;
  static constexpr const char* type_names[] = {"C", "B", "A"};
  light.format = (file.standard.empty() ? std::string("IES LM-63-1986") : "IES " + file.standard) +
                 ", type " + type_names[static_cast<int>(file.type) - 1];
  light.manufacturer = to_utf8(file.keyword("MANUFAC"));
  light.name = to_utf8(file.keyword("LUMINAIRE"));
  light.number = to_utf8(file.keyword("LUMCAT"));
  light.lamp = to_utf8(file.keyword("LAMP"));
  if (const std::string unit = file.keyword("_INTENSITYUNITS"); !unit.empty())
    light.unit = to_utf8(unit);
  light.watts = std::max(file.watts, 0.0);
  light.absolute = file.lumens_per_lamp < 0;
  if (file.lumens_per_lamp > 0 && file.lamps > 0)
    light.lamp_lumens = file.lumens_per_lamp * file.lamps;
  for (const char* key : {"_TOTALLUMINAIRELUMENS", "TOTALLUMINAIRELUMENS"})
    if (double lumens; parse_number(file.keyword(key), lumens) && lumens > 0)
      light.stated_lumens = lumens;
  const double metre = file.units == 1 ? 0.3048 : 1.0;
  light.round = file.width < 0;  // LM-63 codes round openings by negative sizes
  const bool upright = std::abs(std::sin(options.ies_zero)) > 0.5;
  const double along = std::abs(file.length) * metre, across = std::abs(file.width) * metre;
  light.size = {upright ? across : along, upright ? along : across, std::abs(file.height) * metre};

  double factor = file.factor();
  if (file.tilt == IesFile::Tilt::file && file.tilt_angles.empty())
    deviations.push_back({0, "TILT", file.tilt_file, "a file beside this one; taken as NONE"});
  else if (file.tilt != IesFile::Tilt::none)
    factor *= tilt_factor(file, options.tilt * 180 / pi<double>);
  if (!(factor > 0) || !std::isfinite(factor))
    throw Error(name + ": multiplier, ballast factor: found a product of " + format_number(factor) +
                ", expected a positive number");

  FoldedLight folded;
  folded.cd = file.candela;
  for (double& v : folded.cd) v *= factor;
  folded.gamma = file.vertical;
  folded.c = file.horizontal;
  LightFrame frame = ies_frame(options.ies_zero, options.clockwise);
  if (file.type == IesFile::Type::c) {
    folded.symmetry = ies_symmetry(folded.c, deviations);
    light.symmetry = folded.symmetry;
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
        throw Error(
            name +
            ": type B: found a single angle, expected at least 2 vertical and horizontal ones");
      FoldedLight turned;
      turned.sector = true;
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
  return light;
}

Luminaire to_luminaire(const EulumdatFile& file, const std::string& name,
                       const LightOptions& options, Deviations& deviations) {
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
      deviations.push_back({0, "lamp sets", std::to_string(file.lamp_sets.size()),
                            "alternatives; set " + std::to_string(options.lamp_set) + " is taken"});
  }
  if (!light.lamp_lumens)
    deviations.push_back({0, "lamp flux", "none", "a positive number; 1000 lm are taken"});
  light.downward_fraction = file.downward_fraction / 100;
  light.round = file.luminous_width == 0 && file.luminous_length > 0;
  const double y = file.luminous_length / 1000, x = light.round ? y : file.luminous_width / 1000;
  light.size = {x, y,
                *std::max_element(file.luminous_height.begin(), file.luminous_height.end()) / 1000};

  if (!(file.conversion_factor > 0))
    throw Error(name + ": conversion factor: found " + format_number(file.conversion_factor) +
                ", expected a positive number");
  static constexpr LightSymmetry symmetries[] = {LightSymmetry::none, LightSymmetry::rotational,
                                                 LightSymmetry::c0_c180, LightSymmetry::c90_c270,
                                                 LightSymmetry::quadrant};
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

LightFormat light_format(std::string_view text) noexcept {
  if (text.substr(0, 5) == "TILT=" || text.find("\nTILT=") != std::string_view::npos ||
      text.find("\rTILT=") != std::string_view::npos || text.substr(0, 3) == "IES")
    return LightFormat::ies;
  // Lines 2 to 7 of an EULUMDAT file are numbers; the first of them are small integers.
  std::size_t next = 0;
  for (int line = 1; line <= 7; ++line) {
    const std::size_t end = text.find_first_of("\r\n", next);
    if (end == std::string_view::npos) return LightFormat::unknown;
    double value;
    const bool number = parse_number(text.substr(next, end - next), value);
    if (line >= 2 && line != 5 && line != 7 && !number) return LightFormat::unknown;
    next = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
  }
  return LightFormat::eulumdat;
}

Luminaire load_light(const std::filesystem::path& path, const LightOptions& options,
                     Deviations& deviations) {
  const std::string text = read_text(path), name = path.string();
  switch (light_format(text)) {
    case LightFormat::ies: {
      IesFile file = read_ies(text, name, deviations);
      if (file.tilt == IesFile::Tilt::file) {
        const std::filesystem::path beside =
            path.parent_path() / std::filesystem::path(file.tilt_file).filename();
        if (std::filesystem::is_regular_file(beside))
          read_ies_tilt(read_text(beside), beside.string(), file);
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
  Deviations ignored;
  return load_light(path, options, ignored);
}

IesFile to_ies(const Luminaire& light, const LightOptions& options) {
  const LightDiagram diagram =
      in_frame(light.diagram, ies_frame(options.ies_zero, options.clockwise));
  const LightSymmetry symmetry = find_symmetry(diagram);
  FoldedLight folded = fold(diagram, symmetry);
  IesFile file;
  file.standard = "IESNA:LM-63-2002";
  const auto label = [&](const char* key, const std::string& value) {
    file.labels.push_back("[" + std::string(key) + "] " +
                          (value.empty() ? "unknown" : shortened(value, 120)));
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
  file.length = (light.round ? -1 : 1) * (upright ? light.size.y : light.size.x);
  file.height = light.size.z;
  file.watts = light.watts;
  file.vertical = folded.gamma;
  file.horizontal = folded.c;
  file.candela = folded.cd;
  return file;
}

EulumdatFile to_eulumdat(const Luminaire& light) {
  const LightDiagram full = in_frame(light.diagram, LightFrame{});
  const LightSymmetry symmetry = find_symmetry(full);
  const FoldedLight folded = fold(full, symmetry);
  Deviations none;
  const LightDiagram diagram =
      unfold(folded, LightFrame{}, "EULUMDAT", none);  // as a reader will see it
  EulumdatFile file;
  file.company = shortened(light.manufacturer, 78);
  file.name = shortened(light.name, 78);
  file.number = shortened(light.number, 78);
  file.type = symmetry == LightSymmetry::rotational ? 1 : light.size.y > 2 * light.size.x ? 2 : 3;
  static constexpr LightSymmetry order[] = {LightSymmetry::none, LightSymmetry::rotational,
                                            LightSymmetry::c0_c180, LightSymmetry::c90_c270,
                                            LightSymmetry::quadrant};
  file.symmetry =
      static_cast<int>(std::find(std::begin(order), std::end(order), symmetry) - std::begin(order));
  file.length = file.luminous_length = light.size.y * 1000;
  file.width = file.luminous_width = light.round ? 0 : light.size.x * 1000;
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

  for (std::size_t i = 0; i + 1 < diagram.c.size(); ++i)
    file.c.push_back(diagram.c[i] * 180 / pi<double>);
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
