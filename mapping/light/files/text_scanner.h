#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gonio {

/// What a comma between two digits means. Any other comma is a separator.
enum class Comma { separator, thousands, decimal };

/// Reads the lines and numbers of a photometric text file as they occur in the wild: byte order
/// mark, LF, CRLF or CR line ends, commas, semicolons and tabs between numbers.
class TextScanner {
 public:
  /// @param name of the file, for messages. @param text must outlive the scanner.
  TextScanner(std::string name, std::string_view text);

  /// From here on; separator until then.
  void read_commas_as(Comma comma) noexcept { comma_ = comma; }
  /// True if a comma between two digits is left.
  bool commas_left() const noexcept;

  bool at_end() const noexcept { return next_ >= text_.size(); }
  /// The number of the line that the next character is on, from 1.
  int line() const noexcept { return line_; }

  /// The next line without its end, blanks at both ends removed. @throws Error at the end.
  std::string_view next_line(const char* field);
  /// The same, still to be read; empty at the end.
  std::string_view line_ahead() const noexcept;
  /// The next number. @throws Error naming `field` if there is none, it is not a number, or it is
  ///   not finite.
  double next_number(const char* field);
  /// next_number() that must be an integer in [lowest, highest].
  int next_integer(const char* field, int lowest, int highest);
  /// `count` times next_number(). @throws Error as next_number(), and naming the count if the file
  ///   ends before.
  std::vector<double> next_numbers(const char* field, std::size_t count);
  /// True if what comes next, blanks and separators apart, is a number.
  bool number_ahead() const;
  /// True if only blanks and separators are left.
  bool only_blanks_left() const noexcept;
  /// What is left, on one line, shortened to 40 characters: for messages.
  std::string rest() const;

  [[noreturn]] void fail(const char* field, std::string_view found, std::string_view expected) const;

 private:
  std::size_t end_of_line() const noexcept;
  void skip_separators() noexcept;
  bool ends_token(std::size_t at) const noexcept;
  std::string_view next_token(const char* field);

  std::string name_;
  std::string_view text_;
  std::size_t next_ = 0;
  Comma comma_ = Comma::separator;
  int line_ = 1;       // of the next character
  int last_line_ = 1;  // of what was read last: the one that is at fault
};

/// `text` without blanks at both ends.
std::string_view trimmed(std::string_view text) noexcept;
/// The number that is the whole of `text`, blanks around it apart, if it is one and finite. With
/// thousands its commas must stand where those of thousands do ("1,234.5", not "0,950"); with
/// decimal it has at most one comma, and no point beside it.
bool parse_number(std::string_view text, Comma comma, double& value);
/// The text of a file as UTF-8 or what it was before: UTF-16 is converted, told by its byte order
/// mark or by every second byte of its first characters being 0.
std::string without_utf16(std::string bytes);
/// `text` in ASCII capitals.
std::string upper_case(std::string_view text);
/// `text` if it is valid UTF-8, otherwise its bytes read as Latin-1 (as older files are), as UTF-8;
/// control characters become blanks.
std::string to_utf8(std::string_view text);
/// UTF-8 text cut to at most `bytes`, between characters.
std::string shortened(const std::string& text, std::size_t bytes);

}  // namespace gonio
