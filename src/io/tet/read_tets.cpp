// Tets as words: Medit and .tet.

#include <algorithm>
#include <limits>
#include <optional>

#include "base/index.h"
#include "io/contents_hint.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/tet/cell_mesh.h"
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
};
constexpr Section sections[] = {
    {"Edges", 3},
    {"Corners", 1},
    {"Ridges", 1},
    {"RequiredVertices", 1},
    {"RequiredEdges", 1},
    {"RequiredTriangles", 1},
    {"RequiredQuadrilaterals", 1},
    {"Normals", 3},
    {"Tangents", 3},
    {"NormalAtVertices", 2},
    {"TangentAtVertices", 2},
    {"TangentAtEdges", 3},
    {"NormalAtTriangleVertices", 3},
};

struct CellSection {
  const char *name, *element;
  int corners, kind;
};
constexpr CellSection cell_sections[] = {
    {"Triangles", "triangle", 3, CellMesh::triangle},
    {"Quadrilaterals", "quad", 4, CellMesh::quad},
    {"Tetrahedra", "tet", 4, CellMesh::tet},
    {"Hexahedra", "hexahedron", 8, CellMesh::hexahedron},
    {"Hexaedra", "hexahedron", 8, CellMesh::hexahedron},
    {"Prisms", "prism", 6, CellMesh::prism},
    {"Pyramids", "pyramid", 5, CellMesh::pyramid},
};

/// Elements of a section, with a reference each.
void read_elements(WordScanner& scan, const CellSection& section, CellMesh& cells) {
  const int n = scan.count(section.name, 2 * std::size_t(section.corners + 1));
  const int n_vertices = static_cast<int>(cells.points.rows());
  std::vector<int> corners(std::size_t(section.corners));
  for (int e = 0; e < n; ++e) {
    for (int& corner : corners) corner = scan.vertex(section.element, e + 1, 1, n_vertices);
    cells.add(std::size_t(e + 1), section.kind, corners);
    scan.number([&] {
      return "the reference of " + std::string(section.element) + " " + std::to_string(e + 1);
    });
  }
}

void skip_section(WordScanner& scan, const std::string& keyword) {
  for (const Section& s : sections) {
    if (keyword != s.name) continue;
    const int n = scan.count(s.name, 2);
    for (std::int64_t i = 0; i < std::int64_t{n} * s.numbers; ++i)
      scan.number([&] { return "a number of section " + keyword; });
    return;
  }
  scan.fail("unknown section " + in_quotes(keyword));
}

}  // namespace

CellMesh read_medit(std::string_view bytes, const std::string& name) {
  WordScanner scan(bytes, name);
  if (scan.word() != "MeshVersionFormatted") scan.fail("expected MeshVersionFormatted");
  scan.integer([] { return std::string("the version"); });
  CellMesh cells;
  cells.name = name;
  bool vertices = false;
  for (std::string keyword(scan.word()); !keyword.empty() && keyword != "End";
       keyword = scan.word()) {
    const auto section = std::ranges::find_if(
        cell_sections, [&](const CellSection& known) { return keyword == known.name; });
    if (keyword == "Dimension") {
      if (scan.integer([] { return std::string("the dimension"); }) != 3)
        scan.fail("the dimension must be 3");
    } else if (keyword == "Vertices") {
      if (vertices) scan.fail("a second section Vertices");
      vertices = true;
      read_points(scan, scan.count("vertices", 8), 1, true, cells.points);
    } else if (section != std::end(cell_sections)) {
      read_elements(scan, *section, cells);
    } else {
      skip_section(scan, keyword);
    }
  }
  return cells;
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
  file.mesh.tets.resize(index(*n_tets), 4);
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
  const Format& format = format_to_read(extension, name, {Kind::tets});
  TetFile file = read_with_hint(bytes, extension, [&] { return format.read_tets(bytes, name); });
  if (file.mesh.n_tets() == 0) throw InputError(name + ": the file has no tets", "bad-file");
  return file;
}

TetFile read_tets(const std::filesystem::path& path) {
  return read_tets_bytes(FileBytes(path).view(), extension_to_read(path), path.string());
}

}  // namespace littoral::io
