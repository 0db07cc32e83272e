// PLY bodies.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "io/surface/ply_bodies.h"
#include "io/surface/ply_header.h"
#include "io/surface/surface_formats.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

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
  // Where a run of scalars of one type ends; a list is one by itself.
  static std::vector<std::size_t> run_ends(const std::vector<PlyProperty>& properties) {
    std::vector<std::size_t> run_end(properties.size());
    for (std::size_t i = properties.size(); i-- > 0;) {
      const bool goes_on = i + 1 < properties.size() && !properties[i].is_list &&
                           !properties[i + 1].is_list &&
                           properties[i].type == properties[i + 1].type;
      run_end[i] = goes_on ? run_end[i + 1] : i + 1;
    }
    return run_end;
  }

  // Reads the rows of an element from the first on: scalar property i into row_[i], list property
  // `list` into list_.
  template <class Visit>
  void rows(const PlyElement& element, int list, const Visit& visit, std::uint64_t first = 0) {
    const std::vector<PlyProperty>& properties = element.properties;
    row_.assign(properties.size(), 0);
    const auto run_end = run_ends(properties);
    for (std::uint64_t r = first; r < element.count; ++r) {
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

  // The same for scalars, with the row handed to visit(r, row): rows of one size are read side by
  // side.
  template <class Visit>
  void scalar_rows(const PlyElement& element, const Visit& visit) {
    const std::vector<PlyProperty>& properties = element.properties;
    if constexpr (Body::has_sizes) {
      if (std::ranges::none_of(properties, [](const PlyProperty& p) { return p.is_list; })) {
        const auto run_end = run_ends(properties);
        std::size_t bytes = 0;
        for (const PlyProperty& p : properties) bytes += byte_size(p.type);
        parallel_for(std::size_t(element.count), 1 << 14, [&](std::size_t r, std::size_t end) {
          Body body = body_;
          body.pass(r * bytes);
          std::vector<double> row(properties.size());
          for (; r < end; ++r) {
            body.begin_row(element, r);
            for (std::size_t i = 0; i < properties.size(); i = run_end[i])
              body.values(properties[i].type, run_end[i] - i, &row[i]);
            visit(r, row);
          }
        });
        body_.pass(std::size_t(element.count) * bytes);
        return;
      }
    }
    rows(element, unused, [&](std::uint64_t r) { visit(r, row_); });
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
    scalar_rows(element, [&](std::uint64_t r, const std::vector<double>& row) {
      const auto v = index(r);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto column = index(k);
        soup_.points(v, column) = row[position[k]];
        if (normals) soup_.normals(v, column) = row[normal[k]];
      }
      for (const auto& [i, values] : scalars) (*values)(v) = row[i];
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
    std::uint64_t triangles = 0;
    if constexpr (Body::has_sizes)
      if (soup_.corners.empty())
        triangles = body_.take_triangles(element, n_vertices_, soup_.corners);
    // Of triangles, as most are; a row takes four bytes or more.
    const std::uint64_t expected = std::min<std::uint64_t>(element.count, body_.bytes_left() / 4);
    soup_.corners.reserve(3 * (triangles + expected));
    soup_.face_offsets.reserve(triangles + expected + 1);
    for (std::uint64_t f = 1; f <= triangles; ++f)
      soup_.face_offsets.push_back(static_cast<int>(3 * f));
    const auto add = [&](std::uint64_t r) {
      if (list_.size() < 3) {
        body_.fail("face " + std::to_string(r) + " has " +
                   counted(list_.size(), "corner", "corners") + ", at least 3 are needed");
      }
      for (double v : list_) soup_.corners.push_back(vertex(v, "face", r));
      end_face();
    };
    rows(element, list, add, triangles);
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
