// PLY bodies.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/counted.h"
#include "base/index.h"
#include "io/binary.h"
#include "io/surface/ply_header.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

// Values of a text body: a row of an element is a line.
class TextBody {
 public:
  TextBody(std::string_view bytes, const std::string& name, const PlyHeader& header)
      : scan_(bytes.substr(header.body), name, '\0', false, header.body_line) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    if (scan_.next()) return;
    fail("the file ends after " + std::to_string(row) + " of " + std::to_string(element.count) +
         " of element " + in_quotes(element.name));
  }
  double value(PlyType) { return scan_.number("a number"); }
  void values(PlyType, std::uint64_t n, double* out) {
    for (std::uint64_t i = 0; i < n; ++i) out[i] = scan_.number("a number");
  }
  std::uint64_t most_left(PlyType) const { return scan_.line_bytes_left(); }
  /// Some programs write more values behind the corners of a face than their header has.
  void end_row(bool may_have_more) {
    if (!may_have_more) scan_.expect_end();
  }
  std::size_t bytes_left() const { return scan_.line_bytes_left(); }
  [[noreturn]] void fail(const std::string& text) const { scan_.fail(text); }

 private:
  LineScanner scan_;
};

// Values of a binary body.
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, const std::string& name, const PlyHeader& header)
      : bytes_(bytes),
        name_(name),
        order_(header.format == PlyFormat::big_endian ? std::endian::big : std::endian::little),
        at_(header.body) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
  }
  double value(PlyType type) {
    double out = 0;
    values(type, 1, &out);
    return out;
  }
  /// The next n of one type.
  void values(PlyType type, std::uint64_t n, double* out) {
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>(n, out);
      case PlyType::uint8:
        return take<std::uint8_t>(n, out);
      case PlyType::int16:
        return take<std::int16_t>(n, out);
      case PlyType::uint16:
        return take<std::uint16_t>(n, out);
      case PlyType::int32:
        return take<std::int32_t>(n, out);
      case PlyType::uint32:
        return take<std::uint32_t>(n, out);
      case PlyType::float32:
        return take<float>(n, out);
      case PlyType::float64:
        return take<double>(n, out);
    }
  }
  std::uint64_t most_left(PlyType type) const { return bytes_left() / byte_size(type); }
  void end_row(bool) {}
  std::size_t bytes_left() const { return bytes_.size() - at_; }
  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(name_ + ": byte " + std::to_string(at_) + ": " + text, "bad-file");
  }

 private:
  template <class T>
  void take(std::uint64_t n, double* out) {
    const std::uint64_t there = bytes_left() / sizeof(T);
    const char* from = bytes_.data() + at_;
    at_ += std::min(n, there) * sizeof(T);
    if (there < n) {
      fail("the file ends after " + std::to_string(row_) + " of " +
           std::to_string(element_->count) + " of element " + in_quotes(element_->name));
    }
    for (std::uint64_t i = 0; i < n; ++i) out[i] = load<T>(from + i * sizeof(T), order_);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::endian order_;
  std::size_t at_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

constexpr int unused = -1;  // a property that the element does not have

int find_property(const PlyElement& element, std::string_view name, bool is_list) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    if (p.name == name && p.is_list == is_list) return static_cast<int>(i);
  }
  return unused;
}

template <class Body>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, Body body) : header_(header), body_(std::move(body)) {
    for (const PlyElement& e : header.elements)
      if (e.name == "vertex") n_vertices_ = e.count;
  }

  PolygonSoup read(const std::string& name) {
    if (n_vertices_ == 0) throw InputError(name + ": no vertices", "bad-file");
    for (const PlyElement& e : header_.elements) {
      if (e.name == "vertex") {
        read_vertices(e);
      } else if (e.name == "face" && e.count > 0) {
        read_faces(e);
      } else if (e.name == "edge" && e.count > 0) {
        read_edges(e);
      } else if (e.name == "tristrips" && e.count > 0) {
        read_strips(e);
      } else if (!e.properties.empty()) {  // without any it takes no bytes, whatever its count
        rows(e, unused, [](std::uint64_t) {});
      }
    }
    return std::move(soup_);
  }

 private:
  // Reads all rows of an element: scalar property i into row_[i], list property `list` into list_.
  template <class Visit>
  void rows(const PlyElement& element, int list, const Visit& visit) {
    const std::vector<PlyProperty>& properties = element.properties;
    row_.assign(properties.size(), 0);
    std::vector<std::size_t> run_end(properties.size());  // of scalars of one type
    for (std::size_t i = properties.size(); i-- > 0;) {
      const bool goes_on = i + 1 < properties.size() && !properties[i].is_list &&
                           !properties[i + 1].is_list &&
                           properties[i].type == properties[i + 1].type;
      run_end[i] = goes_on ? run_end[i + 1] : i + 1;
    }
    for (std::uint64_t r = 0; r < element.count; ++r) {
      body_.begin_row(element, r);
      for (std::size_t i = 0; i < properties.size(); i = run_end[i]) {
        const PlyProperty& p = properties[i];
        if (p.is_list) {
          read_list(p, static_cast<int>(i) == list);
        } else {
          body_.values(p.type, run_end[i] - i, &row_[i]);
        }
      }
      body_.end_row(list == 0);
      visit(r);
    }
  }

  void read_list(const PlyProperty& p, bool keep) {
    const double length = body_.value(p.count_type);
    constexpr double all_whole = 9e15;  // from here on
    if (!(length >= 0) ||
        (length < all_whole && static_cast<double>(static_cast<std::int64_t>(length)) != length)) {
      body_.fail("a list with a length that is not a whole number");
    }
    // Every item takes at least a byte, so this also bounds the loop.
    if (length > static_cast<double>(body_.bytes_left())) {
      body_.fail("a list of " +
                 std::to_string(static_cast<std::int64_t>(std::min(length, all_whole))) +
                 " items, the file is shorter");
    }
    const auto n = static_cast<std::uint64_t>(length);
    std::vector<double>& items = keep ? list_ : passed_over_;
    items.resize(std::min(n, body_.most_left(p.type)));  // what fails is not made room for
    body_.values(p.type, n, items.data());
  }

  int vertex(double value, const char* element, std::uint64_t row) const {
    const bool there = value >= 0 && value < static_cast<double>(n_vertices_);
    const auto v = there ? static_cast<std::int64_t>(value) : 0;
    if (!there || static_cast<double>(v) != value) {
      std::string text = std::to_string(value);
      if (value == std::floor(value)) text.erase(text.find('.'));
      body_.fail(std::string(element) + " " + std::to_string(row) + " refers to vertex " + text +
                 ", the file has " + std::to_string(n_vertices_) + " (counted from 0)");
    }
    return static_cast<int>(v);
  }

  int needed(const PlyElement& element, const char* property) const {
    const int i = find_property(element, property, false);
    if (i == unused) {
      body_.fail("element " + in_quotes(element.name) + " has no property '" + property + "'");
    }
    return i;
  }

  void read_vertices(const PlyElement& element) {
    const std::array<int, 3> position{needed(element, "x"), needed(element, "y"),
                                      needed(element, "z")};
    const std::array<int, 3> normal{find_property(element, "nx", false),
                                    find_property(element, "ny", false),
                                    find_property(element, "nz", false)};
    const bool normals = normal[0] != unused && normal[1] != unused && normal[2] != unused;
    const auto n = index(element.count);
    std::vector<std::pair<int, VecX*>> scalars;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& p = element.properties[i];
      const int number = static_cast<int>(i);
      const auto is = [&](const auto& set) {
        return std::find(set.begin(), set.end(), number) != set.end();
      };
      if (p.is_list || !is_floating(p.type) || is(position) || (normals && is(normal))) continue;
      const auto [entry, is_new] = soup_.scalars.try_emplace(p.name, VecX(n));
      if (!is_new) body_.fail("property " + in_quotes(p.name) + " appears twice");
      scalars.emplace_back(number, &entry->second);
    }
    soup_.points.resize(n, 3);
    if (normals) soup_.normals.resize(n, 3);
    rows(element, unused, [&](std::uint64_t r) {
      const auto v = index(r);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto column = index(k);
        soup_.points(v, column) = row_[position[k]];
        if (normals) soup_.normals(v, column) = row_[normal[k]];
      }
      for (const auto& [i, values] : scalars) (*values)(v) = row_[i];
    });
  }

  int needed_corners(const PlyElement& element) const {
    int list = find_property(element, "vertex_indices", true);
    if (list == unused) list = find_property(element, "vertex_index", true);
    if (list == unused)
      body_.fail("element " + in_quotes(element.name) + " has no list 'vertex_indices'");
    return list;
  }

  void end_face() {
    if (soup_.corners.size() > std::size_t(std::numeric_limits<int>::max())) {
      body_.fail("more than 2147483647 corners");
    }
    soup_.face_offsets.push_back(static_cast<int>(soup_.corners.size()));
  }

  void read_faces(const PlyElement& element) {
    const int list = needed_corners(element);
    // Of triangles, as most are; a row takes four bytes or more.
    const std::uint64_t expected = std::min<std::uint64_t>(element.count, body_.bytes_left() / 4);
    soup_.corners.reserve(3 * expected);
    soup_.face_offsets.reserve(expected + 1);
    rows(element, list, [&](std::uint64_t r) {
      if (list_.size() < 3) {
        body_.fail("face " + std::to_string(r) + " has " +
                   counted(list_.size(), "corner", "corners") + ", at least 3 are needed");
      }
      for (double v : list_) soup_.corners.push_back(vertex(v, "face", r));
      end_face();
    });
  }

  // A list holds any number of strips, each but the last ended by -1. A vertex after the first two
  // makes a triangle with the two before it; every second one is turned, so that all have the sense
  // of the first. Strips turn corners by repeating vertices: such triangles are none.
  void read_strips(const PlyElement& element) {
    std::uint64_t strip = 0;
    rows(element, needed_corners(element), [&](std::uint64_t) {
      int a = 0, b = 0;
      std::uint64_t length = 0;
      for (double item : list_) {
        if (item == -1) {
          length = 0;
          ++strip;
          continue;
        }
        const int c = vertex(item, "strip", strip);
        if (length >= 2 && a != b && b != c && c != a) {
          const bool turned = length % 2 == 1;
          soup_.corners.insert(soup_.corners.end(), {a, turned ? c : b, turned ? b : c});
          end_face();
        }
        a = b;
        b = c;
        ++length;
      }
      if (length > 0) ++strip;
    });
  }

  void read_edges(const PlyElement& element) {
    const int tail = needed(element, "vertex1"), head = needed(element, "vertex2");
    const int line = find_property(element, "line", false);
    double last_line = 0;
    rows(element, unused, [&](std::uint64_t r) {
      const int a = vertex(row_[tail], "edge", r);
      const int b = vertex(row_[head], "edge", r);
      const double number = line == unused ? 0 : row_[line];
      if (soup_.lines.empty() || soup_.lines.back().back() != a || number != last_line) {
        soup_.lines.push_back({a});
      }
      soup_.lines.back().push_back(b);
      last_line = number;
    });
  }

  const PlyHeader& header_;
  Body body_;
  std::uint64_t n_vertices_ = 0;
  PolygonSoup soup_;
  std::vector<double> row_, list_, passed_over_;
};

}  // namespace

PolygonSoup read_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = read_ply_header(bytes, name);
  if (header.format == PlyFormat::ascii) {
    return PlyReader(header, TextBody(bytes, name, header)).read(name);
  }
  return PlyReader(header, BinaryBody(bytes, name, header)).read(name);
}

}  // namespace littoral::io
