// Geomview OFF, text or binary.

#include <limits>

#include "base/counted.h"
#include "io/binary.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

struct OffHeader {
  bool normals = false, colours = false, texture = false, binary = false;
  std::int64_t vertices = 0, faces = 0;
};

// The numbers of one vertex or face: those of its line, and of the next ones where it has too few.
// What stands behind them on the line, a colour say, is passed over, but not where another line was
// begun for them: there it is more likely the next vertex or face, after a line that lacks numbers.
class Row {
 public:
  explicit Row(LineScanner& scan) : scan_(scan) {}

  double number(const char* what) {
    go_on(what);
    return scan_.number(what);
  }
  std::int64_t integer(const char* what) {
    go_on(what);
    return scan_.integer(what);
  }
  bool went_on() const { return missing_ != nullptr; }
  void end() const {
    if (went_on() && scan_.line_bytes_left() > 0) fail();
  }

 private:
  void go_on(const char* what) {
    if (scan_.line_bytes_left() > 0) return;
    if (!went_on()) {
      missing_ = what;
      line_ = scan_.line();
    }
    if (!scan_.next()) fail();
  }
  [[noreturn]] void fail() const {
    scan_.fail_at(line_, std::string("expected ") + missing_ + ", found the end of the line");
  }

  LineScanner& scan_;
  const char* missing_ = nullptr;  // the first number that its line lacks
  std::size_t line_ = 0;           // that line
};

// The first word: OFF after any of the prefixes ST (texture), C (colour), N (normals), 4 (four
// coordinates), n (any dimension), in this order; the last two do not describe surfaces in space.
// `rest` receives what is glued to the word ("OFF8 6 0" is seen in practice). False: another word.
bool parse_magic(const LineScanner& scan, std::string_view word, OffHeader& header,
                 std::string_view& rest) {
  const auto skip = [&](std::string_view prefix) {
    const bool found = word.starts_with(prefix);
    if (found) word.remove_prefix(prefix.size());
    return found;
  };
  header.texture = skip("ST");
  header.colours = skip("C");
  header.normals = skip("N");
  const bool homogeneous = skip("4"), any_dimension = skip("n");
  if (!skip("OFF") && !skip("off")) return false;
  if (homogeneous) scan.fail("4OFF (four coordinates) is not supported");
  if (any_dimension) scan.fail("nOFF (any dimension) is not supported");
  rest = word;
  return true;
}

OffHeader read_header(LineScanner& scan, std::size_t size) {
  OffHeader header;
  if (!scan.next()) scan.fail("the file is empty");
  std::string_view glued;
  std::string_view word = scan.word();
  if (parse_magic(scan, word, header, glued)) {
    word = glued.empty() ? scan.word() : glued;
    if (word == "BINARY") {
      header.binary = true;
      return header;
    }
    if (word.empty()) {
      if (!scan.next()) scan.fail("the file ends before the counts of vertices and faces");
      word = scan.word();
    }
  }
  const auto vertices = parse_integer(word);
  if (!vertices) scan.fail("expected OFF or the number of vertices, found " + in_quotes(word));
  header.vertices = *vertices;
  Row counts(scan);
  header.faces = counts.integer("the number of faces");
  if (counts.went_on()) counts.integer("the number of edges");
  counts.end();
  // Every vertex and face takes a line or more, and so at least two bytes.
  const auto check = [&](std::int64_t count, const char* what) {
    if (count < 0) scan.fail("negative number of " + std::string(what));
    if (static_cast<std::uint64_t>(count) > size / 2 || count > std::numeric_limits<int>::max()) {
      scan.fail("the header promises " + std::to_string(count) + " " + what + ", the file has " +
                std::to_string(size) + " bytes");
    }
  };
  check(header.vertices, "vertices");
  check(header.faces, "faces");
  return header;
}

void next_row(LineScanner& scan, std::int64_t row, std::int64_t count, const char* what) {
  if (scan.next()) return;
  scan.fail("the file ends after " + std::to_string(row) + " of " + std::to_string(count) + " " +
            what);
}

void read_faces(LineScanner& scan, const OffHeader& header, PolygonSoup& soup) {
  for (std::int64_t f = 0; f < header.faces; ++f) {
    next_row(scan, f, header.faces, "faces");
    Row row(scan);
    const std::int64_t degree = row.integer("the number of corners");
    if (degree < 3) {
      scan.fail("face has " + counted(degree, "corner", "corners") + ", at least 3 are needed");
    }
    std::int64_t outside = 0;  // the first vertex that the file does not have
    std::size_t line = 0;      // where it stands, from 1
    for (std::int64_t k = 0; k < degree; ++k) {
      const std::int64_t v = row.integer("a vertex index");
      if ((v < 0 || v >= header.vertices) && line == 0) {
        outside = v;
        line = scan.line();
      }
      soup.corners.push_back(static_cast<int>(v));
    }
    row.end();  // first: a number of another face is no wrong vertex
    if (line > 0) {
      scan.fail_at(line, "face refers to vertex " + std::to_string(outside) + ", the file has " +
                             std::to_string(header.vertices) + " (counted from 0)");
    }
    if (soup.corners.size() > std::size_t(std::numeric_limits<int>::max())) {
      scan.fail("more than 2147483647 corners");
    }
    soup.face_offsets.push_back(static_cast<int>(soup.corners.size()));
  }
}

// After the first line: counts of vertices, faces and edges; a vertex's coordinates, normal, colour
// (four numbers) and texture (two); a face's corners and colour after the counts of both. All take
// four bytes, the highest first; files of pmp-library have no counts of colours, and the older ones
// of them the lowest byte first.
class BinaryOff {
 public:
  BinaryOff(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
    const std::size_t line = bytes.find('\n');
    at_ = line == std::string_view::npos ? bytes.size() : line + 1;
    if (!counts_fit() && counts_fit(std::endian::little)) order_ = std::endian::little;
  }

  PolygonSoup read(OffHeader header) {
    header.vertices = count("vertices", 12);
    header.faces = count("faces", 8);
    next<std::int32_t>("the number of edges");
    if (header.vertices == 0) throw InputError(name_ + ": no vertices", "bad-file");
    PolygonSoup soup;
    soup.points.resize(header.vertices, 3);
    if (header.normals) soup.normals.resize(header.vertices, 3);
    const int more = (header.colours ? 4 : 0) + (header.texture ? 2 : 0);
    for (std::int64_t v = 0; v < header.vertices; ++v) {
      const auto number = [&] { return next<float>("vertex ", v); };
      for (int k = 0; k < 3; ++k) soup.points(v, k) = number();
      for (int k = 0; k < 3 && header.normals; ++k) soup.normals(v, k) = number();
      for (int k = 0; k < more; ++k) number();
    }
    const bool colours = !faces_fill_file(header.faces);
    for (std::int64_t f = 0; f < header.faces; ++f) read_face(f, header.vertices, colours, soup);
    return soup;
  }

 private:
  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(name_ + ": byte " + std::to_string(at_) + ": " + text, "bad-file");
  }

  template <class T>
  T next(const char* what, std::int64_t number = -1) {
    if (bytes_.size() - at_ < sizeof(T))
      fail("the file ends within " + std::string(what) +
           (number < 0 ? "" : std::to_string(number)));
    at_ += sizeof(T);
    return load<T>(bytes_.data() + at_ - sizeof(T), order_);
  }

  /// Can the file hold as many vertices and triangles as it counts, its bytes in this order?
  bool counts_fit(std::endian order = std::endian::big) const {
    if (bytes_.size() - at_ < 12) return false;
    const std::int64_t vertices = load<std::int32_t>(bytes_.data() + at_, order);
    const std::int64_t faces = load<std::int32_t>(bytes_.data() + at_ + 4, order);
    return vertices > 0 && faces >= 0 &&
           std::uint64_t(12 * vertices + 16 * faces) <= bytes_.size() - at_ - 12;
  }

  /// Do faces of nothing but their corners end where the file does?
  bool faces_fill_file(std::int64_t faces) const {
    std::size_t at = at_;
    for (; faces > 0 && bytes_.size() - at >= 4; --faces) {
      const auto degree = load<std::int32_t>(bytes_.data() + at, order_);
      at += 4;
      if (degree < 0 || std::size_t(degree) > (bytes_.size() - at) / 4) return false;
      at += 4 * std::size_t(degree);
    }
    return faces == 0 && at == bytes_.size();
  }

  /// A count of things of which each takes `least` bytes.
  std::int64_t count(const std::string& what, std::size_t least) {
    const auto n = next<std::int32_t>("the header");
    if (n < 0) fail("negative number of " + what);
    if (std::size_t(n) > (bytes_.size() - at_) / least)
      fail("the header promises " + std::to_string(n) + " " + what + ", the file has " +
           std::to_string(bytes_.size()) + " bytes");
    return n;
  }

  void read_face(std::int64_t f, std::int64_t vertices, bool has_colours, PolygonSoup& soup) {
    const std::string face = "face " + std::to_string(f);
    const auto degree = next<std::int32_t>("face ", f);
    if (degree < 3)
      fail(face + " has " + counted(degree, "corner", "corners") + ", at least 3 are needed");
    for (std::int32_t k = 0; k < degree; ++k) {
      const auto v = next<std::int32_t>("face ", f);
      if (v < 0 || v >= vertices)
        fail(face + " refers to vertex " + std::to_string(v) + ", the file has " +
             std::to_string(vertices) + " (counted from 0)");
      soup.corners.push_back(v);
    }
    if (soup.corners.size() > std::size_t(std::numeric_limits<int>::max()))
      fail("more than 2147483647 corners");
    soup.face_offsets.push_back(static_cast<int>(soup.corners.size()));
    if (!has_colours) return;
    const auto colours = next<std::int32_t>("face ", f);
    if (colours < 0 || std::size_t(colours) > (bytes_.size() - at_) / 4)
      fail(face + " has a colour of " + std::to_string(colours) + " numbers");
    at_ += 4 * std::size_t(colours);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::endian order_ = std::endian::big;
};

}  // namespace

PolygonSoup read_off(std::string_view bytes, const std::string& name) {
  LineScanner scan(without_byte_order_mark(bytes, name), name, '#');
  const OffHeader header = read_header(scan, bytes.size());
  if (header.binary) return BinaryOff(bytes, name).read(header);
  if (header.vertices == 0) throw InputError(name + ": no vertices", "bad-file");
  PolygonSoup soup;
  soup.points.resize(header.vertices, 3);
  if (header.normals) soup.normals.resize(header.vertices, 3);
  for (std::int64_t v = 0; v < header.vertices; ++v) {
    next_row(scan, v, header.vertices, "vertices");
    Row row(scan);
    for (int k = 0; k < 3; ++k) soup.points(v, k) = row.number("a coordinate");
    for (int k = 0; k < 3 && header.normals; ++k) {
      soup.normals(v, k) = row.number("a normal's coordinate");
    }
    row.end();
  }
  read_faces(scan, header, soup);
  return soup;
}

}  // namespace littoral::io
