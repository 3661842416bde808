#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gonio {

/// Reads the lines and numbers of a photometric text file as they occur in the wild: byte order
/// mark, LF, CRLF or CR line ends, commas, semicolons and tabs between numbers.
class TextScanner {
 public:
  /// @param name of the file, for messages. @param text must outlive the scanner.
  TextScanner(std::string name, std::string_view text);

  bool at_end() const noexcept { return next_ >= text_.size(); }
  /// The number of the line that the next character is on, from 1.
  int line() const noexcept { return line_; }

  /// The next line without its end, blanks at both ends removed. @throws Error at the end.
  std::string_view next_line(const char* field);
  /// The next number. @throws Error naming `field` if there is none, it is not a number, or it is
  ///   not finite.
  double next_number(const char* field);
  /// next_number() that must be an integer in [lowest, highest].
  int next_integer(const char* field, int lowest, int highest);
  /// True if only blanks and separators are left.
  bool only_blanks_left() const noexcept;
  /// What is left, on one line, shortened to 40 characters: for messages.
  std::string rest() const;

  [[noreturn]] void fail(const char* field, std::string_view found,
                         std::string_view expected) const;

 private:
  std::string_view next_token(const char* field);

  std::string name_;
  std::string_view text_;
  std::size_t next_ = 0;
  int line_ = 1;       // of the next character
  int last_line_ = 1;  // of what was read last: the one that is at fault
};

/// `text` without blanks at both ends.
std::string_view trimmed(std::string_view text) noexcept;
/// The number that is the whole of `text` (decimal point or comma, blanks around), if it is one and
/// finite.
bool parse_number(std::string_view text, double& value) noexcept;
/// `text` if it is valid UTF-8, otherwise its bytes read as Latin-1 (as older files are), as UTF-8;
/// control characters become blanks.
std::string to_utf8(std::string_view text);
/// UTF-8 text cut to at most `bytes`, between characters.
std::string shortened(const std::string& text, std::size_t bytes);
/// `value` with at most seven significant digits, the shortest such text.
std::string format_number(double value);

}  // namespace gonio
