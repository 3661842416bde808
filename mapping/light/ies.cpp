#include <gonio/mapping/light/ies.h>
#include <gonio/mapping/light/text_scanner.h>

#include <algorithm>
#include <cmath>

namespace gonio {
namespace {

constexpr int most_angles = 10000;

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

void read_tilt_table(TextScanner& scanner, IesFile& file) {
  file.lamp_to_luminaire = scanner.next_integer("TILT: lamp-to-luminaire geometry", 1, 3);
  const int pairs = scanner.next_integer("TILT: number of angles", 1, most_angles);
  file.tilt_angles.clear(), file.tilt_factors.clear();
  for (int i = 0; i < pairs; ++i) file.tilt_angles.push_back(scanner.next_number("TILT: angle"));
  for (int i = 0; i < pairs; ++i) file.tilt_factors.push_back(scanner.next_number("TILT: factor"));
}

void check_header(const IesFile& file, Deviations& deviations) {
  static constexpr std::string_view known[] = {
      "IESNA91",          "IESNA:LM-63-1995", "IESNA:LM-63-2002", "IES:LM-63-2019",
      "IESNA:LM-63-1991", "IESNA:LM-63-2019", "IESNA:LM-63-1986"};
  const std::string& s = file.standard;
  if (s.empty())
    deviations.push_back({1, "first line", "no mark of a standard",
                          "IES:LM-63-2019 or an older one; read as LM-63-1986"});
  else if (std::none_of(std::begin(known), std::end(known), [&](auto k) { return s == k; }))
    deviations.push_back(
        {1, "first line", s, "IESNA91, IESNA:LM-63-1995, IESNA:LM-63-2002 or IES:LM-63-2019"});
  if (s.empty() || s == "IESNA:LM-63-1986") return;
  for (const char* required : {"TEST", "TESTLAB", "ISSUEDATE", "MANUFAC"}) {
    const bool since_1991 =
        std::string_view(required) == "TEST" || std::string_view(required) == "MANUFAC";
    if (!since_1991 && (s == "IESNA91" || s == "IESNA:LM-63-1991" || s == "IESNA:LM-63-1995"))
      continue;
    if (file.keyword(required).empty())
      deviations.push_back({0, std::string("[") + required + "]", "none", "a required keyword"});
  }
  for (std::size_t i = 0; i < file.labels.size(); ++i)
    if (!file.labels[i].empty() && file.labels[i].front() != '[')
      deviations.push_back({static_cast<int>(i) + 2, "label",
                            "\"" + file.labels[i].substr(0, 30) + "\"",
                            "a line that begins with a [KEYWORD]"});
}

void check_angles(const IesFile& f, Deviations& deviations) {
  const auto one_of = [](double v, std::initializer_list<double> values) {
    return std::any_of(values.begin(), values.end(),
                       [&](double x) { return std::abs(x - v) < 1e-6; });
  };
  const auto check = [&](const char* field, double v, std::initializer_list<double> values,
                         const char* expected) {
    if (!one_of(v, values)) deviations.push_back({0, field, format_number(v), expected});
  };
  if (f.type == IesFile::Type::c) {
    check("first vertical angle", f.vertical.front(), {0, 90}, "0 or 90 for type C");
    check("last vertical angle", f.vertical.back(), {90, 180}, "90 or 180 for type C");
    check("first horizontal angle", f.horizontal.front(), {0, 90},
          "0 for type C (90 for symmetry about C90-C270)");
    check("last horizontal angle", f.horizontal.back(), {0, 90, 180, 270, 360},
          "0, 90, 180 or 360 for type C");
  } else {
    check("first vertical angle", f.vertical.front(), {-90, 0}, "-90 or 0 for types A and B");
    check("last vertical angle", f.vertical.back(), {90}, "90 for types A and B");
    check("first horizontal angle", f.horizontal.front(), {-90, 0}, "-90 or 0 for types A and B");
    check("last horizontal angle", f.horizontal.back(), {90}, "90 for types A and B");
  }
}

void check_values(const IesFile& f, Deviations& deviations) {
  if (f.lumens_per_lamp < 0 && f.lumens_per_lamp != -1)
    deviations.push_back(
        {0, "lumens per lamp", format_number(f.lumens_per_lamp), "-1 for absolute photometry"});
  if (f.lumens_per_lamp == 0)
    deviations.push_back(
        {0, "lumens per lamp", "0", "a positive number, or -1 for absolute photometry"});
  if (!(f.multiplier > 0))
    deviations.push_back(
        {0, "candela multiplier", format_number(f.multiplier), "a positive number"});
  if (!(f.ballast_factor > 0))
    deviations.push_back(
        {0, "ballast factor", format_number(f.ballast_factor), "a positive number"});
  if (f.second_factor != 1 && f.factor() == f.multiplier * f.ballast_factor &&
      f.standard != "IES:LM-63-2019")
    deviations.push_back({0, "future use", format_number(f.second_factor), "1"});
  if (f.watts <= 0)
    deviations.push_back({0, "input watts", format_number(f.watts), "a positive number"});
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

double IesFile::factor() const noexcept {
  const bool second = standard.empty() || standard == "IESNA91" || standard == "IESNA:LM-63-1986" ||
                      standard == "IESNA:LM-63-1991" || standard == "IESNA:LM-63-1995";
  return multiplier * ballast_factor * (second ? second_factor : 1);
}

std::string IesFile::keyword(std::string_view name) const {
  std::string value;
  bool inside = false;
  for (const std::string& label : labels) {
    const std::size_t close = label.find(']');
    if (label.empty() || label.front() != '[' || close == std::string::npos) continue;
    const std::string_view key = std::string_view(label).substr(1, close - 1);
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

IesFile read_ies(std::string_view text, const std::string& name, Deviations& deviations) {
  TextScanner scanner(name, text);
  IesFile file;
  bool first = true;
  for (;; first = false) {
    if (scanner.at_end()) scanner.fail("TILT", "no line that begins with TILT=", "one");
    const int line_number = scanner.line();
    const std::string_view line = scanner.next_line("header");
    if (starts_with(line, "TILT=") || starts_with(line, "TILT =")) {
      const std::string_view value = trimmed(line.substr(line.find('=') + 1));
      if (value == "NONE") {
        file.tilt = IesFile::Tilt::none;
      } else if (value == "INCLUDE") {
        file.tilt = IesFile::Tilt::include;
      } else {
        file.tilt = IesFile::Tilt::file;
        file.tilt_file = value;
        if (value.empty()) scanner.fail("TILT", "nothing", "NONE, INCLUDE or the name of a file");
      }
      break;
    }
    if (line.size() > 256)
      deviations.push_back(
          {line_number, "label", std::to_string(line.size()) + " characters", "at most 256"});
    if (first && (starts_with(line, "IES") && !starts_with(line, "IES ")))
      file.standard = line;
    else
      file.labels.emplace_back(line);
  }
  if (file.tilt == IesFile::Tilt::include) read_tilt_table(scanner, file);

  file.lamps = scanner.next_integer("number of lamps", 0, 1000000);
  file.lumens_per_lamp = scanner.next_number("lumens per lamp");
  file.multiplier = scanner.next_number("candela multiplier");
  const int verticals = scanner.next_integer("number of vertical angles", 1, most_angles);
  const int horizontals = scanner.next_integer("number of horizontal angles", 1, most_angles);
  file.type = static_cast<IesFile::Type>(scanner.next_integer("photometric type", 1, 3));
  file.units = scanner.next_integer("units type", 1, 2);
  file.width = scanner.next_number("luminaire width");
  file.length = scanner.next_number("luminaire length");
  file.height = scanner.next_number("luminaire height");
  file.ballast_factor = scanner.next_number("ballast factor");
  file.second_factor = scanner.next_number("future use");
  file.watts = scanner.next_number("input watts");
  for (int i = 0; i < verticals; ++i)
    file.vertical.push_back(scanner.next_number("vertical angles"));
  for (int i = 0; i < horizontals; ++i)
    file.horizontal.push_back(scanner.next_number("horizontal angles"));
  // A broken count must not make us reserve more than the text can hold.
  file.candela.reserve(std::min(
      static_cast<std::size_t>(verticals) * static_cast<std::size_t>(horizontals), text.size()));
  for (int i = 0; i < horizontals; ++i)
    for (int j = 0; j < verticals; ++j)
      file.candela.push_back(scanner.next_number("candela values"));
  if (!scanner.only_blanks_left())
    deviations.push_back({scanner.line(), "after the last candela value",
                          "\"" + scanner.rest() + "\"", "the end of the file; ignored"});
  if (file.lamps == 0) deviations.push_back({0, "number of lamps", "0", "at least 1"});
  check_header(file, deviations);
  check_angles(file, deviations);
  check_values(file, deviations);
  return file;
}

void read_ies_tilt(std::string_view text, const std::string& name, IesFile& file) {
  TextScanner scanner(name, text);
  read_tilt_table(scanner, file);
}

void write_ies(std::ostream& stream, const IesFile& file) {
  LineWriter out(stream);
  if (!file.standard.empty()) stream << file.standard << "\r\n";
  for (const std::string& label : file.labels) stream << label << "\r\n";
  if (file.tilt == IesFile::Tilt::file) {
    stream << "TILT=" << file.tilt_file << "\r\n";
  } else if (file.tilt == IesFile::Tilt::include) {
    stream << "TILT=INCLUDE\r\n"
           << file.lamp_to_luminaire << "\r\n"
           << file.tilt_angles.size() << "\r\n";
    for (double v : file.tilt_angles) out.number(v);
    out.end();
    for (double v : file.tilt_factors) out.number(v);
    out.end();
  } else {
    stream << "TILT=NONE\r\n";
  }
  for (double v :
       {double(file.lamps), file.lumens_per_lamp, file.multiplier, double(file.vertical.size()),
        double(file.horizontal.size()), double(static_cast<int>(file.type)), double(file.units),
        file.width, file.length, file.height})
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
