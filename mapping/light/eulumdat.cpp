#include <gonio/mapping/error.h>
#include <gonio/mapping/light/eulumdat.h>
#include <gonio/mapping/light/text_scanner.h>

#include <algorithm>
#include <cmath>

namespace gonio {
namespace {

/// Fields by line.
class Fields {
 public:
  Fields(std::string name, std::string_view text, Deviations& deviations)
      : scanner_(std::move(name), text), deviations_(deviations) {}

  std::string text(const char* field, std::size_t most) {
    const int line = scanner_.line();
    std::string value(scanner_.next_line(field));
    if (value.size() > most)
      deviations_.push_back({line, field, std::to_string(value.size()) + " characters",
                             "at most " + std::to_string(most)});
    return value;
  }
  double number(const char* field) {
    const std::string_view line = scanner_.next_line(field);
    double value;
    if (!parse_number(line, value))
      scanner_.fail(field, "\"" + std::string(line.substr(0, 40)) + "\"", "a number");
    return value;
  }
  /// A number that some files leave empty.
  double number_or(const char* field, double otherwise) {
    const int line_number = scanner_.line();
    const std::string_view line = scanner_.next_line(field);
    double value;
    if (parse_number(line, value)) return value;
    deviations_.push_back({line_number, field, "\"" + std::string(line.substr(0, 40)) + "\"",
                           "a number; taken as " + format_number(otherwise)});
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
  TextScanner& scanner() { return scanner_; }

 private:
  TextScanner scanner_;
  Deviations& deviations_;
};

bool even(const std::vector<double>& angles, double step) {
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (std::abs(angles[i] - angles[i - 1] - step) > 0.005) return false;
  return true;
}

void check(const EulumdatFile& f, std::size_t lamp_sets, Deviations& deviations) {
  const std::size_t mc = f.c.size();
  const auto note = [&](const char* field, const std::string& found, const char* expected) {
    deviations.push_back({0, field, found, expected});
  };
  if (f.type < 1) note("Ityp", std::to_string(f.type), "1 to 3");
  if (f.symmetry == 2 || f.symmetry == 3 ? mc % 2 != 0 : f.symmetry == 4 && mc % 4 != 0)
    note("Mc", std::to_string(mc), "a multiple of 2 (Isym 2, 3) or 4 (Isym 4)");
  if (f.c_step > 0 && mc > 1 && !even(f.c, f.c_step))
    note("Dc", format_number(f.c_step),
         "the distance of the C angles, or 0 if uneven; the angles are used");
  if (f.g_step > 0 && !even(f.gamma, f.g_step))
    note("Dg", format_number(f.g_step),
         "the distance of the G angles, or 0 if uneven; the angles are used");
  if (f.symmetry != 1 && f.symmetry != 3 && f.c.front() != 0)
    note("first C angle", format_number(f.c.front()), "0");
  if (f.c.back() >= 360) note("last C angle", format_number(f.c.back()), "less than 360");
  if (lamp_sets == 0) note("lamp sets", "none", "1 to 20");
  for (const EulumdatFile::LampSet& set : f.lamp_sets) {
    if (set.lamps == 0)
      note("number of lamps", "0", "a positive number, negative for absolute photometry");
    if (!(set.lumens > 0))
      note("total luminous flux of lamps", format_number(set.lumens), "a positive number");
  }
  if (f.light_output_ratio <= 0)
    note("light output ratio", format_number(f.light_output_ratio), "more than 0");
  if (f.conversion_factor != 1)
    note("conversion factor", format_number(f.conversion_factor), "usually 1; applied");
  if (f.tilt != 0) note("tilt", format_number(f.tilt), "usually 0; not applied");
}

}  // namespace

std::vector<double> EulumdatFile::stored_c() const {
  const std::size_t mc = c.size();
  std::size_t first = 0, count = mc;
  if (symmetry == 1) count = 1;
  if (symmetry == 2) count = mc / 2 + 1;
  if (symmetry == 3) first = 3 * mc / 4, count = mc / 2 + 1;
  if (symmetry == 4) count = mc / 4 + 1;
  std::vector<double> stored;
  for (std::size_t i = first; i < first + count; ++i)
    stored.push_back(c[i % mc] + (i < mc ? 0.0 : 360.0));
  return stored;
}

EulumdatFile read_eulumdat(std::string_view text, const std::string& name, Deviations& deviations) {
  Fields in(name, text, deviations);
  EulumdatFile f;
  f.company = in.text("company", 78);
  f.type = in.integer("Ityp", 0, 3);
  f.symmetry = in.integer("Isym", 0, 4);
  const int mc = in.integer("Mc", 1, 721);
  f.c_step = in.number_or("Dc", 0);
  const int ng = in.integer("Ng", 2, 3601);
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
  f.intensity = in.numbers("luminous intensities", f.stored_c().size() * f.gamma.size());
  if (!in.scanner().only_blanks_left())
    deviations.push_back({in.scanner().line(), "after the last intensity",
                          "\"" + in.scanner().rest() + "\"", "the end of the file; ignored"});
  check(f, f.lamp_sets.size(), deviations);
  return f;
}

void write_eulumdat(std::ostream& stream, const EulumdatFile& f) {
  const auto line = [&](const auto& value) { stream << value << "\r\n"; };
  const auto number = [&](double value) { line(format_number(value)); };
  line(f.company);
  for (int v : {f.type, f.symmetry, static_cast<int>(f.c.size())}) line(v);
  number(f.c_step);
  line(f.gamma.size());
  number(f.g_step);
  for (const std::string* text : {&f.report, &f.name, &f.number, &f.file_name, &f.date})
    line(*text);
  for (double v : {f.length, f.width, f.height, f.luminous_length, f.luminous_width}) number(v);
  for (double v : f.luminous_height) number(v);
  for (double v : {f.downward_fraction, f.light_output_ratio, f.conversion_factor, f.tilt})
    number(v);
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
