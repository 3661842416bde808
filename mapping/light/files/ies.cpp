#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/files/ies.h>
#include <gonio/mapping/light/files/text_scanner.h>

namespace gonio {
namespace {

constexpr int most_angles = 10000;

constexpr const char* comma_names[] = {"between numbers only", "between thousands", "used as decimal points"};

bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

/// The letters and digits of a line, in capitals.
std::string compact(std::string_view line) {
  std::string kept;
  for (char c : upper_case(line))
    if ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')) kept += c;
  return kept;
}

/// What a first line has for the year of its standard, perhaps nothing; no value if it names none.
std::optional<std::string> year_of(std::string_view line) {
  const std::string text = compact(line);
  std::size_t year = text.find("LM63");
  const bool named = year != std::string::npos;
  if (named)
    year += 4;
  else if (starts_with(text, "IES"))  // such as IESNA91
    year = starts_with(text, "IESNA") ? 5 : 3;
  else
    return {};
  const std::size_t end = std::min(text.find_first_not_of("0123456789", year), text.size());
  if (!named && (end == year || end < text.size())) return {};
  return text.substr(year, end - year);
}

void read_tilt_table(TextScanner& scanner, IesFile& file) {
  file.lamp_to_luminaire = scanner.next_integer("TILT: lamp-to-luminaire geometry", 1, 3);
  const auto pairs = static_cast<std::size_t>(scanner.next_integer("TILT: number of angles", 1, most_angles));
  file.tilt_angles = scanner.next_numbers("TILT: angles", pairs);
  file.tilt_factors = scanner.next_numbers("TILT: factors", pairs);
}

/// Angles that no file has come from commas that were misread.
void check_range(const TextScanner& scanner, const std::vector<double>& angles, const char* field) {
  for (double angle : angles)
    if (std::abs(angle) > 720) scanner.fail(field, format_number(angle), "at most 720 degrees");
}

/// Everything from the line after TILT= to the last candela value.
void read_numbers(TextScanner& scanner, IesFile& file) {
  if (file.tilt == IesFile::Tilt::include) read_tilt_table(scanner, file);
  file.lamps = scanner.next_integer("number of lamps", 0, 1000000);
  file.lumens_per_lamp = scanner.next_number("lumens per lamp");
  file.multiplier = scanner.next_number("candela multiplier");
  const auto verticals = static_cast<std::size_t>(scanner.next_integer("number of vertical angles", 1, most_angles));
  const auto horizontals =
      static_cast<std::size_t>(scanner.next_integer("number of horizontal angles", 1, most_angles));
  file.type = static_cast<IesFile::Type>(scanner.next_integer("photometric type", 1, 3));
  file.units = scanner.next_integer("units type", 1, 2);
  file.width = scanner.next_number("luminaire width");
  file.length = scanner.next_number("luminaire length");
  file.height = scanner.next_number("luminaire height");
  file.ballast_factor = scanner.next_number("ballast factor");
  file.second_factor = scanner.next_number("future use");
  file.watts = scanner.next_number("input watts");
  file.vertical = scanner.next_numbers("vertical angles", verticals);
  check_range(scanner, file.vertical, "vertical angles");
  file.horizontal = scanner.next_numbers("horizontal angles", horizontals);
  check_range(scanner, file.horizontal, "horizontal angles");
  file.candela = scanner.next_numbers("candela values", verticals * horizontals);
  if (scanner.number_ahead())
    scanner.fail("candela values",
                 "more numbers after the " + std::to_string(file.candela.size()) + " of " +
                     std::to_string(horizontals) + " horizontal and " + std::to_string(verticals) +
                     " vertical angles: \"" + scanner.rest() + "\"",
                 "the end of the file");
}

/// Calls read(scanner, file) with the first reading of commas that it accepts, and returns that.
/// @throws Error of the standard's reading, commas as separators, if it accepts none.
template <class Read>
Comma read_with_commas(TextScanner& scanner, IesFile& file, const Read& read) {
  const bool commas = scanner.commas_left();
  std::string failure;
  for (Comma comma : {Comma::separator, Comma::thousands, Comma::decimal}) {
    TextScanner attempt = scanner;
    attempt.read_commas_as(comma);
    IesFile result = file;
    try {
      read(attempt, result);
      scanner = attempt;
      file = std::move(result);
      return comma;
    } catch (const Error& error) {
      if (!commas) throw;
      if (failure.empty()) failure = error.what();
    }
  }
  throw Error(failure +
              " (commas read as separators; as decimal points or between thousands they "
              "do not give the counts either)");
}

void check_header(const IesFile& file, Problems& deviations) {
  static constexpr std::string_view known[] = {"IESNA91",         "IESNA:LM-63-1995", "IESNA:LM-63-2002",
                                               "IES:LM-63-2019",  "IESNA:LM-63-1991", "IESNA:LM-63-2019",
                                               "IESNA:LM-63-1986"};
  const std::string& s = file.standard;
  const int edition = file.edition();
  if (s.empty())
    deviations.push_back(
        {"first line", "no mark of a standard", "IES:LM-63-2019 or an older one; read as LM-63-1986", false, 1});
  else if (std::none_of(std::begin(known), std::end(known), [&](auto k) { return s == k; }))
    deviations.push_back({"first line", s,
                          "IESNA91, IESNA:LM-63-1995, IESNA:LM-63-2002 or IES:LM-63-2019; read as LM-63-" +
                              std::to_string(edition > 0 ? edition : 2002),
                          false, 1});
  if (edition == 1986) return;
  for (const char* required : {"TEST", "TESTLAB", "ISSUEDATE", "MANUFAC"}) {
    const bool since_1991 = std::string_view(required) == "TEST" || std::string_view(required) == "MANUFAC";
    if (!since_1991 && (edition == 1991 || edition == 1995)) continue;
    if (file.keyword(required).empty())
      deviations.push_back({std::string("[") + required + "]", "none", "a required keyword", false});
  }
  for (std::size_t i = 0; i < file.labels.size(); ++i)
    if (!file.labels[i].empty() && file.labels[i].front() != '[')
      deviations.push_back({"label", "\"" + file.labels[i].substr(0, 30) + "\"", "a line that begins with a [KEYWORD]",
                            false, static_cast<int>(i) + 2});
}

void check_angles(const IesFile& f, Problems& deviations) {
  const auto one_of = [](double v, std::initializer_list<double> values) {
    return std::any_of(values.begin(), values.end(), [&](double x) { return std::abs(x - v) < 1e-6; });
  };
  const auto check = [&](const char* field, double v, std::initializer_list<double> values, const char* expected) {
    if (!one_of(v, values)) deviations.push_back({field, format_number(v), expected, false});
  };
  if (f.type == IesFile::Type::c) {
    check("first vertical angle", f.vertical.front(), {0, 90}, "0 or 90 for type C");
    check("last vertical angle", f.vertical.back(), {90, 180}, "90 or 180 for type C");
    check("first horizontal angle", f.horizontal.front(), {0, 90}, "0 for type C (90 for symmetry about C90-C270)");
    check("last horizontal angle", f.horizontal.back(), {0, 90, 180, 270, 360}, "0, 90, 180 or 360 for type C");
  } else {
    check("first vertical angle", f.vertical.front(), {-90, 0}, "-90 or 0 for types A and B");
    check("last vertical angle", f.vertical.back(), {90}, "90 for types A and B");
    check("first horizontal angle", f.horizontal.front(), {-90, 0}, "-90 or 0 for types A and B");
    check("last horizontal angle", f.horizontal.back(), {90}, "90 for types A and B");
  }
}

void check_values(const IesFile& f, Problems& deviations) {
  if (f.lumens_per_lamp < 0 && f.lumens_per_lamp != -1)
    deviations.push_back({"lumens per lamp", format_number(f.lumens_per_lamp), "-1 for absolute photometry", false});
  if (f.lumens_per_lamp == 0)
    deviations.push_back({"lumens per lamp", "0", "a positive number, or -1 for absolute photometry", false});
  if (!(f.multiplier > 0))
    deviations.push_back({"candela multiplier", format_number(f.multiplier), "a positive number", false});
  if (!(f.ballast_factor > 0))
    deviations.push_back({"ballast factor", format_number(f.ballast_factor), "a positive number", false});
  const int edition = f.edition();
  if (f.second_factor != 1 && (edition == 1995 || edition == 2002 || edition == 0))
    deviations.push_back({"future use", format_number(f.second_factor), "1; not applied", false});
  if (f.watts <= 0) deviations.push_back({"input watts", format_number(f.watts), "a positive number", false});
}

/// Takes a TILT= line to pieces. False for one that is a label: its value names no way of TILT, and
/// no numbers follow it.
bool read_tilt(const TextScanner& scanner, int line, std::string_view text, std::string_view value, IesFile& file,
               Problems& deviations) {
  const std::string upper = upper_case(value);
  if (upper == "NONE") {
    file.tilt = IesFile::Tilt::none;
  } else if (upper == "INCLUDE") {
    file.tilt = IesFile::Tilt::include;
  } else if (value.empty()) {
    scanner.fail("TILT", "nothing", "NONE, INCLUDE or the name of a file");
  } else {
    if (!scanner.number_ahead()) return false;
    file.tilt = IesFile::Tilt::file;
    file.tilt_file = value;
  }
  const std::string standard = "TILT=" + (file.tilt == IesFile::Tilt::file ? file.tilt_file : upper);
  if (text != standard) deviations.push_back({"TILT", "\"" + std::string(text) + "\"", standard, false, line});
  return true;
}

/// Everything up to and with the line TILT=.
void read_labels(TextScanner& scanner, IesFile& file, Problems& deviations) {
  for (bool first = true;; first = false) {
    if (scanner.at_end()) scanner.fail("TILT", "no line that begins with TILT=", "one");
    const int number = scanner.line();
    const std::string_view line = scanner.next_line("header");
    if (const auto value = tilt_value(line); value && read_tilt(scanner, number, line, *value, file, deviations))
      return;
    if (line.size() > 256)
      deviations.push_back({"label", std::to_string(line.size()) + " characters", "at most 256", false, number});
    if (first && names_ies_standard(line))
      file.standard = line;
    else
      file.labels.emplace_back(line);
  }
}

class LineWriter {
 public:
  explicit LineWriter(std::ostream& stream) : stream_(stream) {}
  void number(double value) {
    const std::string text = format_number(value);
    if (column_ > 0 && column_ + text.size() + 1 > 78) end();
    if (column_ > 0) stream_ << ' ', ++column_;
    stream_ << text;
    column_ += text.size();
  }
  void end() {
    stream_ << "\r\n";
    column_ = 0;
  }

 private:
  std::ostream& stream_;
  std::size_t column_ = 0;
};

}  // namespace

int IesFile::edition() const {
  const std::optional<std::string> year = year_of(standard);
  if (!year) return standard.empty() ? 1986 : 0;
  for (const char* known : {"1986", "1991", "1995", "2002", "2019"})
    if (*year == known || *year == known + 2) return std::atoi(known);
  return 0;
}

double IesFile::factor() const {
  const int year = edition();
  return multiplier * ballast_factor * (year == 1986 || year == 1991 ? second_factor : 1);
}

bool names_ies_standard(std::string_view line) { return year_of(line).has_value(); }

std::optional<std::string_view> tilt_value(std::string_view line) {
  line = trimmed(line);
  if (upper_case(line.substr(0, 4)) != "TILT") return {};
  line = trimmed(line.substr(4));
  if (line.empty() || line.front() != '=') return {};
  return trimmed(line.substr(1));
}

std::string IesFile::keyword(std::string_view name) const {
  std::string value;
  bool inside = false;
  for (const std::string& label : labels) {
    const std::size_t close = label.find(']');
    if (label.empty() || label.front() != '[' || close == std::string::npos) continue;
    const std::string key = upper_case(std::string_view(label).substr(1, close - 1));
    const std::string_view text = trimmed(std::string_view(label).substr(close + 1));
    if (key == "MORE" ? inside : key == name) {
      if (!value.empty()) value += ' ';
      value += text;
      inside = true;
    } else {
      inside = false;
    }
  }
  return value;
}

IesFile read_ies(std::string_view text, const std::string& name, Problems& deviations) {
  TextScanner scanner(name, text);
  IesFile file;
  read_labels(scanner, file, deviations);
  const Comma comma = read_with_commas(scanner, file, read_numbers);
  if (comma != Comma::separator)
    deviations.push_back({"commas", comma_names[static_cast<int>(comma)],
                          "between numbers only; read as found, since the counts come out so", false});
  if (!scanner.only_blanks_left())
    deviations.push_back({"after the last candela value", "\"" + scanner.rest() + "\"", "the end of the file; ignored",
                          false, scanner.line()});
  if (file.lamps == 0) deviations.push_back({"number of lamps", "0", "at least 1", false});
  check_header(file, deviations);
  check_angles(file, deviations);
  check_values(file, deviations);
  return file;
}

void read_ies_tilt(std::string_view text, const std::string& name, IesFile& file) {
  TextScanner scanner(name, text);
  read_with_commas(scanner, file, [](TextScanner& numbers, IesFile& result) {
    read_tilt_table(numbers, result);
    if (numbers.number_ahead())
      numbers.fail("TILT: factors", "more numbers: \"" + numbers.rest() + "\"", "the end of the file");
  });
}

void write_ies(std::ostream& stream, const IesFile& file) {
  LineWriter out(stream);
  if (!file.standard.empty()) stream << file.standard << "\r\n";
  for (const std::string& label : file.labels) stream << label << "\r\n";
  if (file.tilt == IesFile::Tilt::file) {
    stream << "TILT=" << file.tilt_file << "\r\n";
  } else if (file.tilt == IesFile::Tilt::include) {
    stream << "TILT=INCLUDE\r\n" << file.lamp_to_luminaire << "\r\n" << file.tilt_angles.size() << "\r\n";
    for (double v : file.tilt_angles) out.number(v);
    out.end();
    for (double v : file.tilt_factors) out.number(v);
    out.end();
  } else {
    stream << "TILT=NONE\r\n";
  }
  for (double v : {double(file.lamps), file.lumens_per_lamp, file.multiplier, double(file.vertical.size()),
                   double(file.horizontal.size()), double(static_cast<int>(file.type)), double(file.units), file.width,
                   file.length, file.height})
    out.number(v);
  out.end();
  for (double v : {file.ballast_factor, file.second_factor, file.watts}) out.number(v);
  out.end();
  for (double v : file.vertical) out.number(v);
  out.end();
  for (double v : file.horizontal) out.number(v);
  out.end();
  for (std::size_t i = 0; i < file.candela.size(); ++i) {
    out.number(file.candela[i]);
    if ((i + 1) % file.vertical.size() == 0) out.end();
  }
}

}  // namespace gonio
