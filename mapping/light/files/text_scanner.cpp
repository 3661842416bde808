#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include <gonio/mapping/base/error.h>
#include <gonio/mapping/base/format_number.h>
#include <gonio/mapping/light/files/text_scanner.h>

namespace gonio {
namespace {

bool is_separator(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == ';' || c == '\0';
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0'; }

bool parse_plain(std::string_view text, double& value) noexcept {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

/// Removes the commas of `number` if they part its thousands: groups of three digits after a first
/// one that does not begin with 0.
bool take_thousands(std::string& number) {
  const std::size_t first = number.find_first_of("0123456789");
  if (first > 1 || number[first] == '0') return false;
  const std::size_t end = std::min(number.find_first_not_of("0123456789,", first), number.size());
  for (std::size_t k = first; k < end; ++k)
    if ((number[k] == ',') != (k > first && (end - k) % 4 == 0)) return false;
  const auto commas = std::remove(number.begin(), number.end(), ',');
  const bool all = number.end() - commas == static_cast<std::ptrdiff_t>((end - first) / 4);
  number.erase(commas, number.end());
  return all;
}

void append_utf8(std::string& text, unsigned c) {
  const auto add = [&](unsigned byte) { text += static_cast<char>(byte); };
  if (c < 0x80) {
    add(c);
  } else if (c < 0x800) {
    add(0xC0 | c >> 6), add(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    add(0xE0 | c >> 12), add(0x80 | (c >> 6 & 0x3F)), add(0x80 | (c & 0x3F));
  } else {
    add(0xF0 | c >> 18), add(0x80 | (c >> 12 & 0x3F)), add(0x80 | (c >> 6 & 0x3F)), add(0x80 | (c & 0x3F));
  }
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool parse_number(std::string_view text, Comma comma, double& value) {
  text = trimmed(text);
  if (text.find(',') == std::string_view::npos) return parse_plain(text, value);
  std::string plain(text);
  if (comma == Comma::thousands) return take_thousands(plain) && parse_plain(plain, value);
  if (comma == Comma::separator || plain.find('.') != std::string::npos) return false;
  plain[plain.find(',')] = '.';
  return parse_plain(plain, value);
}

std::string without_utf16(std::string bytes) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(bytes[k]); };
  if (bytes.size() < 4) return bytes;
  const bool little =
      (byte(0) == 0xFF && byte(1) == 0xFE) || (byte(0) > 0 && byte(1) == 0 && byte(2) > 0 && byte(3) == 0);
  const bool big = (byte(0) == 0xFE && byte(1) == 0xFF) || (byte(0) == 0 && byte(1) > 0 && byte(2) == 0 && byte(3) > 0);
  if (!little && !big) return bytes;
  const auto unit = [&](std::size_t k) {
    return static_cast<unsigned>(little ? byte(k) | byte(k + 1) << 8 : byte(k) << 8 | byte(k + 1));
  };
  std::string text;
  for (std::size_t k = unit(0) == 0xFEFF ? 2 : 0; k + 1 < bytes.size(); k += 2) {
    unsigned c = unit(k);
    if (c >= 0xD800 && c < 0xDC00 && k + 3 < bytes.size() && unit(k + 2) >= 0xDC00 && unit(k + 2) < 0xE000) {
      c = 0x10000 + ((c - 0xD800) << 10) + (unit(k + 2) - 0xDC00);
      k += 2;
    }
    append_utf8(text, c);
  }
  return text;
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
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
      append_utf8(result, b);
    }
  }
  return result;
}

std::string shortened(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  return text.substr(0, bytes);
}

TextScanner::TextScanner(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {
  if (text_.substr(0, 3) == "\xEF\xBB\xBF") next_ = 3;
}

void TextScanner::fail(const char* field, std::string_view found, std::string_view expected) const {
  throw Error(name_ + ": line " + std::to_string(last_line_) + ": " + field + ": found " + std::string(found) +
              ", expected " + std::string(expected));
}

std::size_t TextScanner::end_of_line() const noexcept {
  return std::min(text_.find_first_of("\r\n", next_), text_.size());
}

std::string_view TextScanner::line_ahead() const noexcept {
  return at_end() ? std::string_view() : trimmed(text_.substr(next_, end_of_line() - next_));
}

std::string_view TextScanner::next_line(const char* field) {
  last_line_ = line_;
  if (at_end()) fail(field, "the end of the file", "a line");
  const std::size_t end = end_of_line();
  const std::string_view line = text_.substr(next_, end - next_);
  next_ = end;
  if (next_ < text_.size() && text_[next_] == '\r') ++next_;
  if (next_ < text_.size() && text_[next_] == '\n' && (next_ == end || text_[next_ - 1] == '\r')) ++next_;
  ++line_;
  return trimmed(line);
}

bool TextScanner::ends_token(std::size_t at) const noexcept {
  if (!is_separator(text_[at])) return false;
  const bool within =
      text_[at] == ',' && at > 0 && at + 1 < text_.size() && is_digit(text_[at - 1]) && is_digit(text_[at + 1]);
  return !within || comma_ == Comma::separator;
}

bool TextScanner::commas_left() const noexcept {
  for (std::size_t k = next_; k + 1 < text_.size(); ++k)
    if (k > 0 && text_[k] == ',' && is_digit(text_[k - 1]) && is_digit(text_[k + 1])) return true;
  return false;
}

void TextScanner::skip_separators() noexcept {
  while (next_ < text_.size() && is_separator(text_[next_])) line_ += text_[next_++] == '\n';
}

std::string_view TextScanner::next_token(const char* field) {
  skip_separators();
  last_line_ = line_;
  if (at_end()) fail(field, "the end of the file", "a number");
  const std::size_t begin = next_;
  while (next_ < text_.size() && !ends_token(next_)) ++next_;
  return text_.substr(begin, next_ - begin);
}

double TextScanner::next_number(const char* field) {
  const std::string_view token = next_token(field);
  double value;
  if (!parse_number(token, comma_, value))
    fail(field, "\"" + std::string(token.substr(0, 40)) + "\"", "a finite number");
  return value;
}

std::vector<double> TextScanner::next_numbers(const char* field, std::size_t count) {
  std::vector<double> values;
  values.reserve(std::min(count, text_.size()));  // a broken count must not reserve more
  while (values.size() < count) {
    skip_separators();
    if (at_end())
      fail(field, "the end of the file after " + std::to_string(values.size()) + " numbers", std::to_string(count));
    values.push_back(next_number(field));
  }
  return values;
}

bool TextScanner::number_ahead() const {
  TextScanner ahead = *this;
  ahead.skip_separators();
  double value;
  return !ahead.at_end() && parse_number(ahead.next_token(""), comma_, value);
}

int TextScanner::next_integer(const char* field, int lowest, int highest) {
  const double value = next_number(field);
  if (value != std::floor(value) || value < lowest || value > highest)
    fail(field, format_number(value), "an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
  return static_cast<int>(value);
}

bool TextScanner::only_blanks_left() const noexcept {
  return std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(std::min(next_, text_.size())), text_.end(),
                     [](char c) { return is_separator(c) || c == '\x1a'; });
}

std::string TextScanner::rest() const {
  std::string rest(trimmed(text_.substr(std::min(next_, text_.size()))).substr(0, 40));
  std::replace_if(rest.begin(), rest.end(), is_blank, ' ');
  return rest;
}

}  // namespace gonio
