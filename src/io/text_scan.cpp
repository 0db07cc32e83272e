#include "io/text_scan.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

#include "base/index.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

// from_chars reads no plus sign; one is taken off here, but not in front of another sign.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
  return word;
}

// For a number known to lie outside the doubles: is it too small (rather than too large)? Its size
// is 10^(exponent + place of the first nonzero digit).
bool underflows(std::string_view word) {
  std::int64_t place = 0;
  bool past_point = false, nonzero = false;
  std::size_t i = 0;
  for (; i < word.size() && word[i] != 'e' && word[i] != 'E'; ++i) {
    if (word[i] == '.') {
      past_point = true;
    } else if (word[i] >= '0' && word[i] <= '9') {
      nonzero = nonzero || word[i] != '0';
      if (!past_point && nonzero) ++place;
      if (past_point && !nonzero) --place;
    }
  }
  if (i == word.size()) return place < 0;
  const std::string_view digits = word.substr(i + 1);
  const auto exponent = parse_integer(digits);
  if (!exponent) return !digits.empty() && digits[0] == '-';  // does not fit 64 bits
  return *exponent < -place;
}

// "1.#INF", "-1.#IND", "1.#QNAN0": what older Windows programs print where a number is not finite.
std::optional<double> parse_windows_special(std::string_view word) {
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  if (!word.starts_with("1.#")) return std::nullopt;
  word.remove_prefix(3);
  while (word.ends_with('0')) word.remove_suffix(1);
  if (word == "INF") {
    return negative ? -infinity : infinity;
  }
  if (word == "IND" || word == "QNAN" || word == "SNAN") {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::nullopt;
}

// Where the comment of a line begins. The sign inside "1.#INF" begins none.
std::size_t find_comment(std::string_view line, char comment) {
  if (comment == '\0') return std::string_view::npos;
  std::size_t at = line.find(comment);
  while (at != std::string_view::npos && at > 0 && line[at - 1] == '.') {
    at = line.find(comment, at + 1);
  }
  return at;
}

}  // namespace

std::optional<double> parse_double(std::string_view word) {
  word = without_plus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return parse_windows_special(word);
  if (error == std::errc::result_out_of_range) {
    if (!underflows(word)) return std::nullopt;
    return word[0] == '-' ? -0.0 : 0.0;
  }
  if (error != std::errc{}) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  word = without_plus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text = "'";
  for (char c : word.substr(0, longest)) text += (c >= ' ' && c <= '~') ? c : '?';
  if (word.size() > longest) text += "...";
  return text + "'";
}

std::string lower_case(std::string text) {
  for (char& c : text) c = (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::string without_percents(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit = [&](std::size_t at) {
      const char c = at < text.size() ? text[at] : '?';
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    const int high = digit(i + 1), low = digit(i + 2);
    if (text[i] == '%' && high >= 0 && low >= 0) {
      out += static_cast<char>(16 * high + low);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string_view without_byte_order_mark(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\xEF\xBB\xBF")) return bytes.substr(3);
  if (bytes.starts_with("\xFE\xFF") || bytes.starts_with("\xFF\xFE")) {
    throw InputError(name + ":1: the text is UTF-16; save it as UTF-8 or ASCII", "bad-file");
  }
  return bytes;
}

LineScanner::LineScanner(std::string_view bytes, std::string name, char comment, bool continuation,
                         std::size_t first_line)
    : bytes_(bytes),
      name_(std::move(name)),
      comment_(comment),
      continuation_(continuation),
      next_line_(first_line),
      line_(first_line) {}

std::string_view LineScanner::physical_line() {
  const std::string_view rest = bytes_.substr(at_);
  const std::size_t length = std::min(rest.find_first_of("\r\n"), rest.size());
  at_ += length;
  if (at_ < bytes_.size()) at_ += rest.substr(length).starts_with("\r\n") ? 2 : 1;
  ++next_line_;
  return rest.substr(0, length);
}

bool LineScanner::next() {
  while (at_ < bytes_.size()) {
    line_ = next_line_;
    joined_.clear();
    bool goes_on = true;
    while (goes_on) {
      std::string_view piece = physical_line();
      const std::size_t comment = find_comment(piece, comment_);
      if (comment != std::string_view::npos) piece = piece.substr(0, comment);
      if (piece.find('\0') != std::string_view::npos)
        fail_at(next_line_ - 1, "NUL byte in a text file");
      // A backslash inside a comment (a Windows path, say) continues nothing.
      goes_on = continuation_ && comment == std::string_view::npos && piece.ends_with('\\') &&
                at_ < bytes_.size();
      if (goes_on) {
        joined_.append(piece.substr(0, piece.size() - 1)).push_back(' ');
      } else if (joined_.empty()) {
        rest_ = piece;
      } else {
        rest_ = joined_.append(piece);
      }
    }
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
    if (!rest_.empty()) return true;
  }
  rest_ = {};
  return false;
}

std::string_view LineScanner::word() {
  std::size_t length = 0;
  while (length < rest_.size() && !is_blank(rest_[length])) ++length;
  const std::string_view result = rest_.substr(0, length);
  rest_.remove_prefix(length);
  while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  return result;
}

std::string decimal_comma_hint(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos) return "";
  std::string pointed(word);
  pointed[comma] = '.';
  return parse_double(pointed) ? "; write a point, not a comma, before the decimals" : "";
}

double LineScanner::number(const char* what) {
  const std::string_view text = word();
  if (text.empty()) fail(std::string("expected ") + what + ", found the end of the line");
  const auto value = parse_double(text);
  if (!value)
    fail(std::string("expected ") + what + ", found " + in_quotes(text) + decimal_comma_hint(text));
  return *value;
}

std::int64_t LineScanner::integer(const char* what) {
  const std::string_view text = word();
  if (text.empty()) fail(std::string("expected ") + what + ", found the end of the line");
  const auto value = parse_integer(text);
  if (!value) fail(std::string("expected ") + what + ", found " + in_quotes(text));
  return *value;
}

void LineScanner::expect_end() {
  if (!rest_.empty()) fail("unexpected " + in_quotes(word()) + " at the end of the line");
}

void LineScanner::fail_at(std::size_t line, const std::string& text) const {
  throw InputError(name_ + ":" + std::to_string(line) + ": " + text, "bad-file");
}

}  // namespace littoral::io
