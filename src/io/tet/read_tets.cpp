// Tets as words: Medit and .tet.

#include <limits>
#include <optional>

#include "io/formats.h"
#include "io/read.h"
#include "io/tet/tet_formats.h"
#include "littoral/error.h"

namespace littoral::io {

int WordScanner::count(const char* what, std::size_t least) {
  const std::int64_t n = integer([&] { return std::string("the number of ") + what; });
  if (n < 0) fail("negative number of " + std::string(what));
  if (static_cast<std::uint64_t>(n) > size_ / least || n > std::numeric_limits<int>::max())
    fail("the file promises " + std::to_string(n) + " " + what + ", it has " +
         std::to_string(size_) + " bytes");
  return static_cast<int>(n);
}

int WordScanner::vertex(const char* element, int number, int base, int n_vertices) {
  const auto label = [&] { return std::string(element) + " " + std::to_string(number); };
  const std::int64_t v = integer([&] { return "a vertex of " + label(); });
  if (v < base || v - base >= n_vertices)
    fail(label() + " refers to vertex " + std::to_string(v) + ", the file has " +
         std::to_string(n_vertices) + " (counted from " + std::to_string(base) + ")");
  return static_cast<int>(v - base);
}

namespace {

void read_points(WordScanner& scan, int n, int base, bool reference, MatX3& points) {
  points.resize(n, 3);
  for (int v = 0; v < n; ++v) {
    for (int k = 0; k < 3; ++k)
      points(v, k) =
          scan.number([&] { return "a coordinate of vertex " + std::to_string(v + base); });
    if (reference) scan.number([&] { return "the reference of vertex " + std::to_string(v + 1); });
  }
}

struct Section {
  const char* name;
  int numbers;  // per element, its reference among them
  bool solid;   // a cell in space that is no tetrahedron
};
constexpr Section sections[] = {
    {"Edges", 3, false},
    {"Corners", 1, false},
    {"Ridges", 1, false},
    {"RequiredVertices", 1, false},
    {"RequiredEdges", 1, false},
    {"RequiredTriangles", 1, false},
    {"Quadrilaterals", 5, false},
    {"RequiredQuadrilaterals", 1, false},
    {"Hexahedra", 9, true},
    {"Hexaedra", 9, true},
    {"Prisms", 7, true},
    {"Pyramids", 6, true},
    {"Normals", 3, false},
    {"Tangents", 3, false},
    {"NormalAtVertices", 2, false},
    {"TangentAtVertices", 2, false},
    {"TangentAtEdges", 3, false},
    {"NormalAtTriangleVertices", 3, false},
};

/// Elements of a section, with a reference each.
template <int corners>
void read_elements(WordScanner& scan, const char* what, const char* element, int n_vertices,
                   Rows<int, corners>& out) {
  const int n = scan.count(what, 2 * (corners + 1));
  out.resize(n, corners);
  for (int e = 0; e < n; ++e) {
    for (int k = 0; k < corners; ++k) out(e, k) = scan.vertex(element, e + 1, 1, n_vertices);
    scan.number(
        [&] { return "the reference of " + std::string(element) + " " + std::to_string(e + 1); });
  }
}

void skip_section(WordScanner& scan, const std::string& keyword) {
  for (const Section& s : sections) {
    if (keyword != s.name) continue;
    const int n = scan.count(s.name, 2);
    if (s.solid && n > 0)
      throw UnsupportedError("section " + keyword + ": only tetrahedra fill space here",
                             "unsupported-file");
    for (std::int64_t i = 0; i < std::int64_t{n} * s.numbers; ++i)
      scan.number([&] { return "a number of section " + keyword; });
    return;
  }
  scan.fail("unknown section " + in_quotes(keyword));
}

}  // namespace

TetFile read_medit(std::string_view bytes, const std::string& name) {
  WordScanner scan(bytes, name);
  if (scan.word() != "MeshVersionFormatted") scan.fail("expected MeshVersionFormatted");
  scan.integer([] { return std::string("the version"); });
  TetFile file;
  bool vertices = false;
  for (std::string keyword(scan.word()); !keyword.empty() && keyword != "End";
       keyword = scan.word()) {
    if (keyword == "Dimension") {
      if (scan.integer([] { return std::string("the dimension"); }) != 3)
        scan.fail("the dimension must be 3");
    } else if (keyword == "Vertices") {
      if (vertices) scan.fail("a second section Vertices");
      vertices = true;
      read_points(scan, scan.count("vertices", 8), 1, true, file.mesh.points);
    } else if (keyword == "Tetrahedra") {
      read_elements<4>(scan, "tetrahedra", "tet", file.mesh.n_vertices(), file.mesh.tets);
    } else if (keyword == "Triangles") {
      read_elements<3>(scan, "triangles", "triangle", file.mesh.n_vertices(), file.triangles);
    } else {
      try {
        skip_section(scan, keyword);
      } catch (const UnsupportedError& e) {
        throw UnsupportedError(name + ": " + e.what(), e.code());
      }
    }
  }
  return file;
}

TetFile read_tet(std::string_view bytes, const std::string& name) {
  WordScanner scan(bytes, name);
  TetFile file;
  const int n = scan.count("vertices", 6);
  // "125 vertices 384 tets", or the numbers alone.
  std::string_view next = scan.word();
  std::optional<std::int64_t> n_tets = parse_integer(next);
  if (!n_tets) {
    if (next != "vertices") scan.fail("expected the word vertices, found " + in_quotes(next));
    n_tets = scan.count("tets", 10);
    next = scan.word();
    if (next != "tets" && next != "cells") scan.fail("expected the word tets");
  } else if (*n_tets < 0 || static_cast<std::uint64_t>(*n_tets) > bytes.size() / 10) {
    scan.fail("the file promises " + std::to_string(*n_tets) + " tets, it has " +
              std::to_string(bytes.size()) + " bytes");
  }
  read_points(scan, n, 0, false, file.mesh.points);
  file.mesh.tets.resize(static_cast<Eigen::Index>(*n_tets), 4);
  for (int t = 0; t < file.mesh.n_tets(); ++t) {
    const auto corners =
        scan.integer([&] { return "the number of corners of tet " + std::to_string(t); });
    if (corners != 4)
      scan.fail("cell " + std::to_string(t) + " has " + std::to_string(corners) +
                " corners, a tet has 4");
    for (int k = 0; k < 4; ++k) file.mesh.tets(t, k) = scan.vertex("tet", t, 0, n);
  }
  return file;
}

TetFile read_tets_bytes(std::string_view bytes, const std::string& extension,
                        const std::string& name) {
  TetFile file = format_to_read(extension, name, {Kind::tets}).read_tets(bytes, name);
  if (file.mesh.n_tets() == 0) throw InputError(name + ": the file has no tets", "bad-file");
  return file;
}

TetFile read_tets(const std::filesystem::path& path) {
  return read_tets_bytes(read_bytes(path), path.extension().string(), path.string());
}

}  // namespace littoral::io
