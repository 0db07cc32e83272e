#include "io/tet/cell_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "base/option_table.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

// Faces seen from outside counter-clockwise; -1: it has three corners.
constexpr std::array<std::array<int, 4>, 6> hexahedron_faces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
constexpr std::array<std::array<int, 4>, 5> prism_faces{
    {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
constexpr std::array<std::array<int, 4>, 5> pyramid_faces{
    {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};

/// Triangles of a polygon, all of them at its smallest number.
template <class Visit>
void fan(std::span<const int> corners, const Visit& visit) {
  const std::size_t n = corners.size();
  const auto first = std::size_t(std::ranges::min_element(corners) - corners.begin());
  for (std::size_t k = 1; k + 1 < n; ++k)
    visit(corners[first], corners[(first + k) % n], corners[(first + k + 1) % n]);
}

bool differ(const std::array<int, 4>& v) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (v[i] == v[j]) return false;
  return true;
}

}  // namespace

int CellMesh::corner(std::size_t number, double vertex) const {
  if (vertex >= 0 && vertex < static_cast<double>(points.rows()) && vertex == std::floor(vertex))
    return static_cast<int>(vertex);
  throw InputError(name + ": cell " + std::to_string(number) + " refers to vertex " +
                       number_text(vertex) + ", the file has " + std::to_string(points.rows()) +
                       " (counted from 0)",
                   "bad-file");
}

void CellMesh::check_corners(std::size_t number, int kind, std::size_t corners,
                             std::size_t needed) const {
  const bool any = kind == polygon || kind == triangle_strip;
  if (any ? corners >= needed : corners == needed) return;
  throw InputError(name + ": cell " + std::to_string(number) + " of type " + std::to_string(kind) +
                       " must have " + std::to_string(needed) + " corners" +
                       (any ? " or more" : "") + ", it has " + std::to_string(corners),
                   "bad-file");
}

void CellMesh::add(std::size_t number, int kind, std::span<const int> c) {
  const auto check = [&](std::size_t needed) { check_corners(number, kind, c.size(), needed); };
  switch (kind) {
    case triangle:
      check(3);
      return faces.add_face(c);
    case triangle_strip:
      check(3);
      for (std::size_t i = 0; i + 2 < c.size(); ++i)
        faces.add_face(std::array{c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]});
      return;
    case polygon:
      check(3);
      return faces.add_face(c);
    case pixel:
      check(4);
      return faces.add_face(std::array{c[0], c[1], c[3], c[2]});
    case quad:
      check(4);
      return faces.add_face(c);
    case tet:
      check(4);
      tets.insert(tets.end(), c.begin(), c.end());
      return;
    case voxel:
      check(8);
      return add_cone(std::array{c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6]}, hexahedron_faces);
    case hexahedron:
      check(8);
      return add_cone(c, hexahedron_faces);
    case prism:
      check(6);
      return add_cone(c, prism_faces);
    case pyramid:
      check(5);
      return add_cone(c, pyramid_faces);
    default:
      if (kind >= 0 && kind <= last_without_area) return;
      throw UnsupportedError(
          name + ": cell " + std::to_string(number) + " is of type " + std::to_string(kind) +
              "; triangles, quads, polygons, tets, hexahedra, prisms and pyramids "
              "with straight sides are read",
          "unsupported-file");
  }
}

void CellMesh::add_line(std::span<const int> corners) {
  if (corners.size() > 1) faces.lines.emplace_back(corners.begin(), corners.end());
}

void CellMesh::add_cone(std::span<const int> corners, std::span<const std::array<int, 4>> sides) {
  const int tip = *std::ranges::min_element(corners);
  for (const std::array<int, 4>& side : sides) {
    std::array<int, 4> held{};
    std::size_t n = 0;
    for (const int k : side)
      if (k >= 0) held[n++] = corners[k];
    const std::span<const int> face(held.data(), n);
    if (std::ranges::find(face, tip) != face.end()) continue;
    fan(face, [&](int a, int b, int c) {
      const std::array<int, 4> found{tip, a, b, c};
      if (differ(found)) tets.insert(tets.end(), found.begin(), found.end());
    });
  }
}

TetFile CellMesh::as_tets() {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (tets.size() / 4 > most || faces.corners.size() > most)
    throw InputError(name + ": more than 2147483647 cells", "bad-file");
  TetFile file;
  file.mesh.tets = Eigen::Map<const Rows<int, 4>>(tets.data(), index(tets.size() / 4), 4);
  file.mesh.points = std::move(points);
  file.scalars = std::move(scalars);
  std::vector<int> triangles;
  for (int f = 0; f < faces.n_faces(); ++f)
    fan(faces.face(f), [&](int a, int b, int c) { triangles.insert(triangles.end(), {a, b, c}); });
  file.triangles = Eigen::Map<const MatX3i>(triangles.data(), index(triangles.size() / 3), 3);
  return file;
}

PolygonSoup CellMesh::as_surface() {
  if (points.rows() == 0) throw InputError(name + ": no vertices", "bad-file");
  if (faces.n_faces() == 0 && solid())
    throw InputError(name + ": it holds " + std::to_string(tets.size() / 4) +
                         " tets and no faces of its own; it is read as tets",
                     "bad-file");
  if (faces.corners.size() > std::size_t(std::numeric_limits<int>::max()))
    throw InputError(name + ": more than 2147483647 corners", "bad-file");
  faces.points = std::move(points);
  faces.scalars = std::move(scalars);
  return std::move(faces);
}

Content CellMesh::as_what_it_is() {
  if (solid()) return as_tets();
  return as_surface();
}

}  // namespace littoral::io
