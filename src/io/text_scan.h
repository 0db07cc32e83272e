#pragma once
// Lines and words of a text file, with errors that say where. Numbers never depend on the locale.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace littoral::io {

/// The whole word as a double ("+1", ".5", "1e3", "nan", "inf" and "1.#INF" count, hexadecimal does
/// not), or nothing. Numbers too small for a double become zero, numbers too large are nothing.
std::optional<double> parse_double(std::string_view word);

/// The whole word as an integer with an optional sign, or nothing.
std::optional<std::int64_t> parse_integer(std::string_view word);

/// What to add to a message about a word that is no number: something where it has a decimal comma.
std::string decimal_comma_hint(std::string_view word);

/// A word in quotes for a message: shortened, unprintable bytes shown as '?'.
std::string in_quotes(std::string_view word);

/// The text with the letters A to Z in lower case.
std::string lower_case(std::string text);

/// Is this one of the blanks that separate words within a line?
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// A text in which "%20" stands for a blank, and so on for any byte.
std::string without_percents(std::string_view text);

/// Text without the UTF-8 byte-order mark; throws InputError for UTF-16.
std::string_view without_byte_order_mark(std::string_view bytes, const std::string& name);

/// Walks over the lines of a text that hold at least one word. Lines end in LF, CRLF or CR; a NUL
/// byte is an InputError, since no text format allows it.
class LineScanner {
 public:
  /// `comment` starts a comment that runs to the end of the line ('\0': none), except after a dot.
  /// With `continuation` a line ending in a backslash goes on in the next one. Lines are numbered
  /// from `first_line`.
  LineScanner(std::string_view bytes, std::string name, char comment, bool continuation = false,
              std::size_t first_line = 1);

  /// Goes to the next line with a word; false at the end of the text.
  bool next();
  /// The next word of the line; empty where there is none left.
  std::string_view word();
  /// The next word as a double; throws InputError saying that `what` was expected.
  double number(const char* what);
  /// The next word as an integer; throws InputError saying that `what` was expected.
  std::int64_t integer(const char* what);
  /// Throws InputError if the line has another word.
  void expect_end();

  std::size_t line() const { return line_; }
  /// What is left of the line.
  std::string_view rest_of_line() const { return rest_; }
  std::size_t line_bytes_left() const { return rest_.size(); }
  /// Throws InputError "name:line: text" for the current line, or for another one.
  [[noreturn]] void fail(const std::string& text) const { fail_at(line_, text); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& text) const;

 private:
  std::string_view physical_line();

  std::string_view bytes_;
  std::string name_;
  char comment_;
  bool continuation_;
  std::size_t at_ = 0;     // first byte not yet read
  std::size_t next_line_;  // number of the line that starts there
  std::size_t line_;       // number of the current line
  std::string_view rest_;  // what is left of the current line
  std::string joined_;     // the current line where it was continued
};

}  // namespace littoral::io
