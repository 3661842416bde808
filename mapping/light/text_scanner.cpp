#include <gonio/mapping/error.h>
#include <gonio/mapping/light/deviation.h>
#include <gonio/mapping/light/text_scanner.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace gonio {
namespace {

bool is_separator(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == ';' || c == '\0';
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0'; }

bool parse_plain(std::string_view text, double& value) noexcept {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

}  // namespace

std::string to_string(const Deviation& d) {
  const std::string where = d.line > 0 ? "line " + std::to_string(d.line) + ": " : std::string();
  return where + d.field + ": found " + d.found + ", expected " + d.expected;
}

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool parse_number(std::string_view text, double& value) noexcept {
  text = trimmed(text);
  if (parse_plain(text, value)) return true;
  if (text.size() > 40 || std::count(text.begin(), text.end(), ',') != 1) return false;
  std::string point(text);
  std::replace(point.begin(), point.end(), ',', '.');
  return parse_plain(point, value);
}

std::string to_utf8(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  bool valid = true;
  for (std::size_t k = 0; k < text.size() && valid;) {
    const unsigned char b = byte(k++);
    const int more = b < 0x80                ? 0
                     : b >= 0xC2 && b < 0xE0 ? 1
                     : b >= 0xE0 && b < 0xF0 ? 2
                     : b >= 0xF0 && b < 0xF5 ? 3
                                             : -1;
    valid = more >= 0;
    for (int m = 0; m < more && valid; ++m) valid = k < text.size() && (byte(k++) & 0xC0) == 0x80;
  }
  std::string result;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const unsigned char b = byte(k);
    if (b < 0x20) {
      result += ' ';
    } else if (b < 0x80 || valid) {
      result += text[k];
    } else {
      result += static_cast<char>(0xC0 | b >> 6);
      result += static_cast<char>(0x80 | (b & 0x3F));
    }
  }
  return result;
}

std::string shortened(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  return text.substr(0, bytes);
}

std::string format_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

TextScanner::TextScanner(std::string name, std::string_view text)
    : name_(std::move(name)), text_(text) {
  if (text_.substr(0, 3) == "\xEF\xBB\xBF") next_ = 3;
}

void TextScanner::fail(const char* field, std::string_view found, std::string_view expected) const {
  throw Error(name_ + ": line " + std::to_string(last_line_) + ": " + field + ": found " +
              std::string(found) + ", expected " + std::string(expected));
}

std::string_view TextScanner::next_line(const char* field) {
  last_line_ = line_;
  if (at_end()) fail(field, "the end of the file", "a line");
  const std::size_t end = std::min(text_.find_first_of("\r\n", next_), text_.size());
  const std::string_view line = text_.substr(next_, end - next_);
  next_ = end;
  if (next_ < text_.size() && text_[next_] == '\r') ++next_;
  if (next_ < text_.size() && text_[next_] == '\n' && (next_ == end || text_[next_ - 1] == '\r'))
    ++next_;
  ++line_;
  return trimmed(line);
}

std::string_view TextScanner::next_token(const char* field) {
  while (next_ < text_.size() && is_separator(text_[next_])) line_ += text_[next_++] == '\n';
  last_line_ = line_;
  if (at_end()) fail(field, "the end of the file", "a number");
  const std::size_t begin = next_;
  while (next_ < text_.size() && !is_separator(text_[next_])) ++next_;
  return text_.substr(begin, next_ - begin);
}

double TextScanner::next_number(const char* field) {
  const std::string_view token = next_token(field);
  double value;
  if (!parse_plain(token, value))
    fail(field, "\"" + std::string(token.substr(0, 40)) + "\"", "a finite number");
  return value;
}

int TextScanner::next_integer(const char* field, int lowest, int highest) {
  const double value = next_number(field);
  if (value != std::floor(value) || value < lowest || value > highest)
    fail(field, format_number(value),
         "an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
  return static_cast<int>(value);
}

bool TextScanner::only_blanks_left() const noexcept {
  return std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(std::min(next_, text_.size())),
                     text_.end(), [](char c) { return is_separator(c) || c == '\x1a'; });
}

std::string TextScanner::rest() const {
  std::string rest(trimmed(text_.substr(std::min(next_, text_.size()))).substr(0, 40));
  std::replace_if(rest.begin(), rest.end(), is_blank, ' ');
  return rest;
}

}  // namespace gonio
