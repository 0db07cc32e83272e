#pragma once
// Words and numbers of VTK's legacy files.

#include <limits>
#include <string>
#include <string_view>

#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

/// Lines with keywords, between them numbers as text or bytes.
class VtkScanner {
 public:
  VtkScanner(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  bool binary = false;

  std::size_t size() const { return bytes_.size(); }

  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(
        name_ +
            (binary ? ": byte " + std::to_string(at_) + ": " : ":" + std::to_string(line_) + ": ") +
            text,
        "bad-file");
  }
  [[noreturn]] void unsupported(const std::string& text) const {
    throw UnsupportedError(name_ + ": " + text, "unsupported-file");
  }

  /// The rest of the current line; the next one becomes current.
  std::string_view rest_of_line() {
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_end(bytes_[at_])) ++at_;
    const std::string_view text = bytes_.substr(begin, at_ - begin);
    if (at_ < bytes_.size()) {
      if (bytes_[at_] == '\r' && at_ + 1 < bytes_.size() && bytes_[at_ + 1] == '\n') ++at_;
      ++at_;
      ++line_;
    }
    return text;
  }
  /// The next word on any line; empty at the end.
  std::string_view word() {
    while (at_ < bytes_.size() && (is_blank(bytes_[at_]) || is_end(bytes_[at_]))) {
      if (bytes_[at_] == '\n') ++line_;
      ++at_;
    }
    return word_of_line();
  }
  /// The next word on the current line; empty where there is none.
  std::string_view word_of_line() {
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_]) && !is_end(bytes_[at_])) ++at_;
    return bytes_.substr(begin, at_ - begin);
  }
  /// A keyword in lower case; where another one stands, it stays the next.
  bool take(std::string_view wanted) {
    const std::size_t at = at_, line = line_;
    if (lower_case(std::string(word())) == wanted) return true;
    at_ = at;
    line_ = line;
    return false;
  }

  std::int64_t count(const char* what) {
    const std::string_view text = word_of_line();
    const auto n = parse_integer(text);
    if (!n || *n < 0)
      fail("expected the number of " + std::string(what) + ", found " + in_quotes(text));
    // Every number takes a byte at least.
    if (static_cast<std::uint64_t>(*n) > bytes_.size() || *n > std::numeric_limits<int>::max())
      fail("the file promises " + std::to_string(*n) + " " + what + ", it has " +
           std::to_string(bytes_.size()) + " bytes");
    return *n;
  }

  /// Three numbers on the current line.
  Vec3 three_of_line(const std::string& what) {
    Vec3 out;
    for (int i = 0; i < 3; ++i) {
      const std::string_view text = word_of_line();
      const auto value = parse_double(text);
      if (!value)
        fail("expected number " + std::to_string(i) + " of " + what + ", found " +
             (text.empty() ? "the end of the line" : in_quotes(text)));
      out[i] = *value;
    }
    return out;
  }

  /// `n` numbers from the next line on; `type` as VTK calls it.
  VecX numbers(std::int64_t n, const std::string& type, const char* what) {
    const NumberKind kind = kind_of(type);
    if (binary) {
      rest_of_line();
      const auto size = static_cast<std::uint64_t>(n) * kind.size;
      if (size > bytes_.size() - at_)
        fail("the file ends within " + std::to_string(n) + " numbers of " + what);
      VecX out = load_numbers(bytes_.substr(at_), kind, std::size_t(n), std::endian::big);
      at_ += size;
      return out;
    }
    if (static_cast<std::uint64_t>(n) > bytes_.size() - at_)
      fail("the file ends within " + std::to_string(n) + " numbers of " + what);
    VecX out(n);
    for (std::int64_t i = 0; i < n; ++i) {
      const std::string_view text = word();
      const auto value = parse_double(text);
      if (!value)
        fail("expected number " + std::to_string(i) + " of " + what + ", found " +
             (text.empty() ? "the end of the file" : in_quotes(text)));
      out[i] = *value;
    }
    return out;
  }

  /// Passes texts over, from the next line on: lines, or bytes behind their number, the two highest
  /// bits of which say in how many bytes it stands.
  void skip_texts(std::int64_t n) {
    rest_of_line();
    for (std::int64_t i = 0; i < n; ++i) {
      if (at_ >= bytes_.size()) fail("the file ends within " + std::to_string(n) + " texts");
      if (!binary) {
        rest_of_line();
        continue;
      }
      const auto first = static_cast<unsigned char>(bytes_[at_]);
      const std::size_t held = std::size_t{8} >> (first >> 6);
      std::uint64_t length = first & 63u;
      if (held > bytes_.size() - at_) fail("the file ends within the length of a text");
      for (std::size_t k = 1; k < held; ++k)
        length = length << 8 | static_cast<unsigned char>(bytes_[at_ + k]);
      at_ += held;
      if (length > bytes_.size() - at_) fail("the file ends within a text");
      at_ += length;
    }
  }

 private:
  static bool is_end(char c) { return c == '\n' || c == '\r'; }
  NumberKind kind_of(const std::string& type) const {
    const std::string t = lower_case(type);
    if (t == "double") return {'f', 8};
    if (t == "float") return {'f', 4};
    if (t == "char" || t == "signed_char") return {'i', 1};
    if (t == "unsigned_char") return {'u', 1};
    if (t == "short") return {'i', 2};
    if (t == "unsigned_short") return {'u', 2};
    if (t == "int" || t == "vtkidtype" || t == "vtktypeint32") return {'i', 4};
    if (t == "unsigned_int" || t == "vtktypeuint32") return {'u', 4};
    if (t == "long" || t == "vtktypeint64") return {'i', 8};
    if (t == "unsigned_long" || t == "vtktypeuint64") return {'u', 8};
    fail("numbers of type " + in_quotes(type) + " are not read");
  }

  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0, line_ = 1;
};

}  // namespace littoral::io
