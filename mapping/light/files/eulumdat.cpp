#include <algorithm>
#include <cmath>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/files/eulumdat.h>
#include <gonio/mapping/light/files/text_scanner.h>

namespace gonio {
namespace {

/// Fields by line.
class Fields {
 public:
  Fields(std::string name, std::string_view text, Comma comma, Problems& deviations)
      : scanner_(std::move(name), text), comma_(comma), deviations_(deviations) {}

  std::string text(const char* field, std::size_t most) {
    const int line = scanner_.line();
    std::string value(scanner_.next_line(field));
    if (value.size() > most)
      deviations_.push_back(
          {field, std::to_string(value.size()) + " characters", "at most " + std::to_string(most), false, line});
    return value;
  }
  double number(const char* field) {
    const std::string_view line = scanner_.next_line(field);
    double value;
    if (!parse(line, value)) scanner_.fail(field, "\"" + std::string(line.substr(0, 40)) + "\"", "a number");
    return value;
  }
  /// A number that some files leave empty.
  double number_or(const char* field, double otherwise) {
    const int line_number = scanner_.line();
    const std::string_view line = scanner_.next_line(field);
    double value;
    if (parse(line, value)) return value;
    deviations_.push_back({field, "\"" + std::string(line.substr(0, 40)) + "\"",
                           "a number; taken as " + format_number(otherwise), false, line_number});
    return otherwise;
  }
  int integer(const char* field, int lowest, int highest) {
    const double value = number(field);
    if (value != std::floor(value) || value < lowest || value > highest)
      scanner_.fail(field, format_number(value),
                    "an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
    return static_cast<int>(value);
  }
  std::vector<double> numbers(const char* field, std::size_t count) {
    std::vector<double> values;
    values.reserve(count);
    while (values.size() < count) values.push_back(number(field));
    return values;
  }
  /// Every number up to the first line that is none.
  std::vector<double> numbers_ahead(const char* field) {
    std::vector<double> values;
    for (double value; parse(scanner_.line_ahead(), value); values.push_back(value)) scanner_.next_line(field);
    return values;
  }
  const TextScanner& scanner() const { return scanner_; }
  /// All commas that were read can part thousands.
  bool commas_could_be_thousands() const { return could_be_thousands_ && !decimal_commas_; }
  bool has_points() const { return points_; }

 private:
  bool parse(std::string_view line, double& value) {
    double other;
    const bool decimal = parse_number(line, Comma::decimal, value);
    const bool thousands = parse_number(line, Comma::thousands, other);
    if (line.find('.') != std::string_view::npos) points_ = points_ || decimal || thousands;
    if (line.find(',') != std::string_view::npos) {
      could_be_thousands_ = could_be_thousands_ || thousands;
      decimal_commas_ = decimal_commas_ || (decimal && !thousands);
    }
    if (thousands && (comma_ == Comma::thousands || !decimal)) value = other;
    return decimal || thousands;
  }

  TextScanner scanner_;
  Comma comma_;
  Problems& deviations_;
  bool points_ = false, could_be_thousands_ = false, decimal_commas_ = false;
};

constexpr double same_plane = 5e-4;  // [deg]; abrupt edges are two planes a thousandth apart

struct Range {
  double from, to;  // [deg]
};

/// Where the stored planes of a symmetry are: in the first of these, or in the one that holds all
/// planes that are listed.
std::vector<Range> ranges_of(int symmetry) {
  if (symmetry == 2) return {{0, 180}, {180, 360}};
  if (symmetry == 3) return {{270, 450}, {90, 270}};
  return {{0, 90}, {90, 180}, {180, 270}, {270, 360}};
}

/// `c` by whole turns to [from, from + 360).
double turned_to(double c, double from) {
  const double t = c - 360 * std::floor((c - from + same_plane) / 360);
  return std::abs(t - from) < same_plane ? from : t;
}

struct Planes {
  std::vector<double> c;   // each once, ascending from the start of the range
  std::size_t stored = 0;  // how many of them lie in the range
};

Planes planes_in(const std::vector<double>& listed, const Range& range) {
  Planes planes;
  for (double c : listed) planes.c.push_back(turned_to(c, range.from));
  std::sort(planes.c.begin(), planes.c.end());
  const auto same = [](double a, double b) { return std::abs(a - b) < same_plane; };
  planes.c.erase(std::unique(planes.c.begin(), planes.c.end(), same), planes.c.end());
  for (double c : planes.c) planes.stored += c < range.to + same_plane;
  return planes;
}

/// The planes of a symmetry (2 to 4), from the first that is stored on.
Planes planes_of(const std::vector<double>& listed, int symmetry) {
  const std::vector<Range> ranges = ranges_of(symmetry);
  for (const Range& range : ranges)
    if (Planes planes = planes_in(listed, range); planes.stored == planes.c.size()) return planes;
  return planes_in(listed, ranges.front());
}

/// The widest gap between planes [deg], once around.
double widest_gap(const Planes& planes) {
  double widest = planes.c.front() + 360 - planes.c.back();
  for (std::size_t i = 1; i < planes.c.size(); ++i) widest = std::max(widest, planes.c[i] - planes.c[i - 1]);
  return widest;
}

/// Planes ascend; they may begin anywhere, and pass 360 once.
void check_order(const TextScanner& scanner, const std::vector<double>& c) {
  int steps_back = 0;
  for (std::size_t i = 1; i < c.size(); ++i) {
    steps_back += c[i] <= c[i - 1];
    if (steps_back > (c.front() > c.back() ? 1 : 0) || std::abs(c[i] - c.front()) > 360 + same_plane)
      scanner.fail("C angles", format_number(c[i]) + " after " + format_number(c[i - 1]),
                   "ascending angles within one turn");
  }
}

/// The number of planes that the symmetry of `f` leaves in the file.
std::size_t planes_expected(const EulumdatFile& f, Problems& deviations) {
  const std::size_t mc = f.c.size();
  if (f.symmetry < 2) return f.symmetry == 1 ? 1 : mc;
  const Planes planes = planes_of(f.c, f.symmetry);
  if (planes.stored == planes.c.size()) {
    if (mc > 1)
      deviations.push_back({"Mc", std::to_string(mc) + ", the stored planes alone", "the number of all planes", false});
    return planes.stored;
  }
  // Where no plane lies in the plane of symmetry the first of the next half is stored too.
  const std::size_t by_index = mc / (f.symmetry == 4 ? 4 : 2) + 1;
  const bool one_more = by_index > planes.stored && f.intensity.size() == by_index * f.gamma.size();
  return one_more ? by_index : planes.stored;
}

/// Settles which planes the intensities of `f` belong to: their number says it.
void check_planes(const TextScanner& scanner, EulumdatFile& f, Problems& deviations) {
  check_order(scanner, f.c);
  const std::size_t ng = f.gamma.size(), found = f.intensity.size();
  const std::size_t expected = planes_expected(f, deviations);
  const bool closed = f.c.size() == 1 || widest_gap(planes_in(f.c, {0, 360})) < 180 - same_plane;
  if (found == f.c.size() * ng && found != expected * ng && closed) {
    deviations.push_back({"Isym", std::to_string(f.symmetry) + ", but intensities of all planes",
                          "those of the stored planes only; all are used, as with 0", false});
    f.symmetry = 0;
  } else if (found != expected * ng) {
    scanner.fail("luminous intensities",
                 std::to_string(found) + " numbers up to " +
                     (scanner.at_end() ? "the end of the file" : "\"" + scanner.rest() + "\""),
                 std::to_string(expected * ng) + " (" + std::to_string(expected) + " planes of " + std::to_string(ng) +
                     " gamma angles)");
  } else if (f.symmetry == 0 && !closed) {
    deviations.push_back({"C angles", format_number(f.c.front()) + " to " + format_number(f.c.back()),
                          "a full turn; closed by interpolation", false});
  }
}

bool even(const std::vector<double>& angles, double step) {
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (std::abs(angles[i] - angles[i - 1] - step) > 0.005) return false;
  return true;
}

void check(const EulumdatFile& f, std::size_t lamp_sets, Problems& deviations) {
  const auto note = [&](const char* field, const std::string& found, const char* expected) {
    deviations.push_back({field, found, expected, false});
  };
  if (f.c.size() > 721) note("Mc", std::to_string(f.c.size()), "at most 721");
  if (f.gamma.size() > 361) note("Ng", std::to_string(f.gamma.size()), "at most 361");
  if (f.type < 1) note("Ityp", std::to_string(f.type), "1 to 3");
  if (f.c_step > 0 && f.c.size() > 1 && !even(f.c, f.c_step))
    note("Dc", format_number(f.c_step), "the distance of the C angles, or 0 if uneven; the angles are used");
  if (f.g_step > 0 && !even(f.gamma, f.g_step))
    note("Dg", format_number(f.g_step), "the distance of the G angles, or 0 if uneven; the angles are used");
  if (f.symmetry != 1 && f.c.front() != 0) note("first C angle", format_number(f.c.front()), "0");
  if (f.c.back() >= 360) note("last C angle", format_number(f.c.back()), "less than 360");
  if (lamp_sets == 0) note("lamp sets", "none", "1 to 20");
  for (const EulumdatFile::LampSet& set : f.lamp_sets) {
    if (set.lamps == 0) note("number of lamps", "0", "a positive number, negative for absolute photometry");
    if (!(set.lumens > 0)) note("total luminous flux of lamps", format_number(set.lumens), "a positive number");
  }
  if (f.light_output_ratio <= 0) note("light output ratio", format_number(f.light_output_ratio), "more than 0");
  if (f.conversion_factor != 1) note("conversion factor", format_number(f.conversion_factor), "usually 1; applied");
  if (f.tilt != 0) note("tilt", format_number(f.tilt), "usually 0; not applied");
}

EulumdatFile read(Fields& in, Problems& deviations) {
  EulumdatFile f;
  f.company = in.text("company", 78);
  f.type = in.integer("Ityp", 0, 3);
  f.symmetry = in.integer("Isym", 0, 4);
  const int mc = in.integer("Mc", 1, most_eulumdat_angles);
  f.c_step = in.number_or("Dc", 0);
  const int ng = in.integer("Ng", 2, most_eulumdat_angles);
  f.g_step = in.number_or("Dg", 0);
  f.report = in.text("measurement report", 78);
  f.name = in.text("luminaire name", 78);
  f.number = in.text("luminaire number", 78);
  f.file_name = in.text("file name", 78);
  f.date = in.text("date/user", 78);
  f.length = in.number_or("length", 0);
  f.width = in.number_or("width", 0);
  f.height = in.number_or("height", 0);
  f.luminous_length = in.number_or("length of luminous area", 0);
  f.luminous_width = in.number_or("width of luminous area", 0);
  for (double& h : f.luminous_height) h = in.number_or("height of luminous area", 0);
  f.downward_fraction = in.number_or("DFF", 0);
  f.light_output_ratio = in.number_or("LORL", 100);
  f.conversion_factor = in.number_or("conversion factor", 1);
  f.tilt = in.number_or("tilt", 0);
  const int sets = in.integer("number of lamp sets", 0, 1000);
  for (int i = 0; i < sets; ++i) {
    EulumdatFile::LampSet set;
    set.lamps = in.integer("number of lamps", -1000000, 1000000);
    set.type = in.text("type of lamps", 78);
    set.lumens = in.number("total luminous flux of lamps");
    set.colour = in.text("colour of light", 78);
    set.rendering = in.text("colour rendering", 78);
    set.watts = in.number_or("wattage", 0);
    f.lamp_sets.push_back(std::move(set));
  }
  for (double& ratio : f.direct_ratios) ratio = in.number_or("direct ratio", 0);
  f.c = in.numbers("C angles", static_cast<std::size_t>(mc));
  f.gamma = in.numbers("G angles", static_cast<std::size_t>(ng));
  f.intensity = in.numbers_ahead("luminous intensities");
  check_planes(in.scanner(), f, deviations);
  if (!in.scanner().only_blanks_left())
    deviations.push_back({"after the last intensity", "\"" + in.scanner().rest() + "\"", "the end of the file; ignored",
                          false, in.scanner().line()});
  check(f, f.lamp_sets.size(), deviations);
  return f;
}

}  // namespace

std::vector<double> EulumdatFile::stored_c() const {
  const std::size_t count = gamma.empty() ? 0 : intensity.size() / gamma.size();
  std::vector<double> planes = symmetry >= 2 ? planes_of(c, symmetry).c : c;
  planes.resize(std::min(count, planes.size()));
  for (std::size_t i = 1; i < planes.size(); ++i)
    if (planes[i] < planes[i - 1]) planes[i] += 360;
  return planes;
}

EulumdatFile read_eulumdat(std::string_view text, const std::string& name, Problems& deviations) {
  const Problems before = deviations;
  Fields in(name, text, Comma::decimal, deviations);
  EulumdatFile file = read(in, deviations);
  if (!in.commas_could_be_thousands()) return file;
  if (!in.has_points()) {
    deviations.push_back(
        {"commas", "some that can part thousands, and no decimal points", "decimal points; read as such", false});
    return file;
  }
  deviations = before;
  Fields again(name, text, Comma::thousands, deviations);
  file = read(again, deviations);
  deviations.push_back({"commas", "between thousands", "decimal points; read as found", false});
  return file;
}

void write_eulumdat(std::ostream& stream, const EulumdatFile& f) {
  const auto line = [&](const auto& value) { stream << value << "\r\n"; };
  const auto number = [&](double value) { line(format_number(value)); };
  line(f.company);
  for (int v : {f.type, f.symmetry, static_cast<int>(f.c.size())}) line(v);
  number(f.c_step);
  line(f.gamma.size());
  number(f.g_step);
  for (const std::string* text : {&f.report, &f.name, &f.number, &f.file_name, &f.date}) line(*text);
  for (double v : {f.length, f.width, f.height, f.luminous_length, f.luminous_width}) number(v);
  for (double v : f.luminous_height) number(v);
  for (double v : {f.downward_fraction, f.light_output_ratio, f.conversion_factor, f.tilt}) number(v);
  line(f.lamp_sets.size());
  for (const EulumdatFile::LampSet& set : f.lamp_sets) {
    line(set.lamps);
    line(set.type);
    number(set.lumens);
    line(set.colour);
    line(set.rendering);
    number(set.watts);
  }
  for (double v : f.direct_ratios) number(v);
  for (double v : f.c) number(v);
  for (double v : f.gamma) number(v);
  for (double v : f.intensity) number(v);
}

}  // namespace gonio
