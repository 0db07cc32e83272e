#include "io/surface/ply_header.h"

#include <array>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> type_names{{
    {"char", PlyType::int8},
    {"int8", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},
    {"short", PlyType::int16},
    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"uint16", PlyType::uint16},
    {"int", PlyType::int32},
    {"int32", PlyType::int32},
    {"uint", PlyType::uint32},
    {"uint32", PlyType::uint32},
    {"float", PlyType::float32},
    {"float32", PlyType::float32},
    {"double", PlyType::float64},
    {"float64", PlyType::float64},
}};

// Header lines one at a time: the body after end_header is not text, so nothing may look past it.
class HeaderLines {
 public:
  HeaderLines(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  // The words of the next line.
  std::vector<std::string_view> next() {
    ++line_;
    const std::string_view rest = bytes_.substr(at_);
    const std::size_t length = rest.find_first_of("\r\n");
    if (length == std::string_view::npos) fail("the file ends inside the header");
    at_ += length;
    // The first line tells whether a lone CR ends lines; then LF may already be data.
    const bool pair = rest.substr(length).starts_with("\r\n");
    if (line_ == 1) lone_cr_ = rest[length] == '\r' && !pair;
    at_ += (pair && !lone_cr_) ? 2 : 1;
    return words(rest.substr(0, length));
  }
  std::size_t at() const { return at_; }
  std::size_t line() const { return line_; }
  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(name_ + ":" + std::to_string(line_) + ": " + text, "bad-file");
  }

 private:
  static std::vector<std::string_view> words(std::string_view text) {
    std::vector<std::string_view> result;
    while (true) {
      while (!text.empty() && is_blank(text[0])) text.remove_prefix(1);
      if (text.empty()) return result;
      std::size_t length = 0;
      while (length < text.size() && !is_blank(text[length])) ++length;
      result.push_back(text.substr(0, length));
      text.remove_prefix(length);
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0, line_ = 0;
  bool lone_cr_ = false;
};

using Words = std::vector<std::string_view>;

PlyType parse_type(const HeaderLines& lines, std::string_view word) {
  for (const auto& [name, type] : type_names) {
    if (name == word) return type;
  }
  lines.fail("unknown type " + in_quotes(word));
}

PlyFormat parse_format(const HeaderLines& lines, const Words& words) {
  const std::string_view format = words.size() > 1 ? words[1] : std::string_view{};
  if (format == "ascii") return PlyFormat::ascii;
  if (format == "binary_little_endian") return PlyFormat::little_endian;
  if (format == "binary_big_endian") return PlyFormat::big_endian;
  lines.fail("unknown format " + in_quotes(format));
}

PlyElement parse_element(const HeaderLines& lines, const Words& words) {
  if (words.size() != 3) lines.fail("expected 'element NAME COUNT'");
  const auto count = parse_integer(words[2]);
  if (!count || *count < 0) lines.fail("expected a count, found " + in_quotes(words[2]));
  return {std::string(words[1]), static_cast<std::uint64_t>(*count), {}};
}

PlyProperty parse_property(const HeaderLines& lines, const Words& words) {
  PlyProperty property;
  property.is_list = words.size() > 1 && words[1] == "list";
  if (words.size() != (property.is_list ? 5u : 3u)) {
    lines.fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  }
  property.type = parse_type(lines, words[words.size() - 2]);
  property.name = std::string(words.back());
  if (property.is_list) {
    property.count_type = parse_type(lines, words[2]);
    if (is_floating(property.count_type)) lines.fail("the length of a list must be an integer");
  }
  return property;
}

// The least a row takes: in text a digit and a blank for every property.
std::uint64_t least_row_size(const PlyElement& element, PlyFormat format) {
  std::uint64_t size = 0;
  for (const PlyProperty& p : element.properties) {
    size += format == PlyFormat::ascii ? 2 : byte_size(p.is_list ? p.count_type : p.type);
  }
  return size;
}

}  // namespace

std::size_t byte_size(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      break;
  }
  return 8;
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& name) {
  HeaderLines lines(bytes, name);
  PlyHeader header;
  if (bytes.empty()) throw InputError(name + ": the file is empty", "bad-file");
  if (!bytes.starts_with("ply") || lines.next() != Words{"ply"}) {
    throw InputError(name + ":1: expected the word 'ply'", "bad-file");
  }
  bool has_format = false;
  std::set<std::string> names;
  while (true) {
    const Words words = lines.next();
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      if (has_format) lines.fail("the format is given twice");
      header.format = parse_format(lines, words);
      has_format = true;
    } else if (words[0] == "element") {
      PlyElement element = parse_element(lines, words);
      if (!names.insert(element.name).second)
        lines.fail("element " + in_quotes(element.name) + " appears twice");
      header.elements.push_back(std::move(element));
    } else if (words[0] == "property") {
      if (header.elements.empty()) lines.fail("a property before the first element");
      header.elements.back().properties.push_back(parse_property(lines, words));
    } else {
      lines.fail("unknown header line " + in_quotes(words[0]));
    }
  }
  if (!has_format) lines.fail("the header has no format line");
  header.body = lines.at();
  header.body_line = lines.line() + 1;
  // One byte more: the last line of a text needs no line end.
  const std::uint64_t left = bytes.size() - header.body + 1;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t row = least_row_size(element, header.format);
    if (row == 0) continue;
    if (element.count > left / row || element.count > std::numeric_limits<int>::max()) {
      throw InputError(name + ": the header promises " + std::to_string(element.count) +
                           " of element " + in_quotes(element.name) + ", " +
                           std::to_string(left - 1) + " bytes follow it",
                       "bad-file");
    }
  }
  return header;
}

}  // namespace littoral::io
