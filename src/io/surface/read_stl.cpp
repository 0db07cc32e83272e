// STL, text and binary.

#include <array>
#include <cstring>
#include <limits>

#include "io/binary.h"
#include "io/surface/point_merger.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

constexpr std::size_t header_size = 84;    // 80 bytes of text and the count
constexpr std::size_t triangle_size = 50;  // normal, three corners, two bytes of attributes

bool same_word(std::string_view word, std::string_view expected) {
  return word.size() == expected.size() && lower_case(std::string(word)) == expected;
}

// Words of the text form: line breaks mean nothing in it, except after solid and endsolid.
class StlWords {
 public:
  StlWords(std::string_view bytes, const std::string& name) : scan_(bytes, name, '\0') {}

  std::string_view next() {
    std::string_view word = scan_.word();
    while (word.empty() && scan_.next()) word = scan_.word();
    return word;
  }
  void expect(std::string_view keyword) {
    const std::string_view word = next();
    if (word.empty()) fail("the file ends where '" + std::string(keyword) + "' is expected");
    if (!same_word(word, keyword)) {
      fail("expected '" + std::string(keyword) + "', found " + in_quotes(word));
    }
  }
  double coordinate() {
    const std::string_view word = next();
    if (word.empty()) fail("the file ends inside a vertex");
    const auto value = parse_double(word);
    if (!value) fail("expected a coordinate, found " + in_quotes(word));
    return *value;
  }
  void skip_line() {
    while (!scan_.word().empty()) continue;
  }
  [[noreturn]] void fail(const std::string& text) const { scan_.fail(text); }

 private:
  LineScanner scan_;
};

// facet normal x y z / outer loop / vertex x y z (three times) / endloop / endfacet, after "facet".
void read_facet(StlWords& words, PointMerger& merger, PolygonSoup& soup) {
  words.expect("normal");
  // The normal is not used, and some programs write words in it that are no numbers.
  for (int k = 0; k < 3; ++k) words.next();
  words.expect("outer");
  words.expect("loop");
  std::array<int, 3> corners{};
  for (int& corner : corners) {
    words.expect("vertex");
    const double x = words.coordinate(), y = words.coordinate(), z = words.coordinate();
    corner = merger.vertex(x, y, z);
  }
  words.expect("endloop");
  words.expect("endfacet");
  soup.add_face(corners);
}

PolygonSoup read_text(std::string_view bytes, const std::string& name) {
  StlWords words(without_byte_order_mark(bytes, name), name);
  PointMerger merger;
  PolygonSoup soup;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (same_word(word, "solid") || same_word(word, "endsolid")) {
      words.skip_line();
    } else if (same_word(word, "facet")) {
      read_facet(words, merger, soup);
    } else {
      words.fail("expected 'facet', 'solid' or 'endsolid', found " + in_quotes(word));
    }
  }
  soup.points = merger.points();
  return soup;
}

PolygonSoup read_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < header_size) {
    throw InputError(name + ": byte " + std::to_string(bytes.size()) +
                         ": the file ends inside the header of a binary STL",
                     "bad-file");
  }
  const std::uint64_t count = load_little<std::uint32_t>(bytes.data() + 80);
  const std::uint64_t fit = (bytes.size() - header_size) / triangle_size;
  // Programs add trailing bytes, but never a whole triangle.
  if (count != fit || count > std::numeric_limits<int>::max() / 3) {
    throw InputError(name + ": byte 80: the header says " + std::to_string(count) +
                         " triangles, the data hold " + std::to_string(fit),
                     "bad-file");
  }
  PointMerger merger;
  PolygonSoup soup;
  for (std::uint64_t f = 0; f < count; ++f) {
    const char* corner = bytes.data() + header_size + f * triangle_size + 12;
    std::array<int, 3> corners{};
    for (int& number : corners) {
      std::array<double, 3> p{};
      for (double& x : p) {
        x = load_little<float>(corner);
        corner += sizeof(float);
      }
      number = merger.vertex(p[0], p[1], p[2]);
    }
    soup.add_face(corners);
  }
  soup.points = merger.points();
  return soup;
}

// Many binary files begin with "solid", so the size decides first.
bool is_text(std::string_view bytes) {
  if (is_binary_stl(bytes, bytes.size())) return false;
  std::string_view text = bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
  while (!text.empty() && (is_blank(text[0]) || text[0] == '\r' || text[0] == '\n')) {
    text.remove_prefix(1);
  }
  const bool begins_as_text = same_word(text.substr(0, 5), "solid");
  return begins_as_text && text.substr(0, 1000).find('\0') == std::string_view::npos;
}

}  // namespace

bool is_binary_stl(std::string_view first, std::uint64_t size) {
  if (first.size() < header_size) return false;
  const std::uint64_t count = load_little<std::uint32_t>(first.data() + 80);
  return count > 0 && size == header_size + count * triangle_size;
}

PolygonSoup read_stl(std::string_view bytes, const std::string& name) {
  PolygonSoup soup = is_text(bytes) ? read_text(bytes, name) : read_binary(bytes, name);
  if (soup.n_vertices() == 0) throw InputError(name + ": no vertices", "bad-file");
  return soup;
}

}  // namespace littoral::io
