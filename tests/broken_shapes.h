#pragma once
// Soups cut, turned and put together, for tests with known answers.

#include <algorithm>
#include <vector>

#include "spatial/boundary_edges.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral::test {

/// The faces of a soup of triangles for which `keep` holds.
template <class Keep>
PolygonSoup part_of(const PolygonSoup& soup, const Keep& keep) {
  PolygonSoup out;
  out.points = soup.points;
  for (int f = 0; f < soup.n_faces(); ++f) {
    Vec3 centre = Vec3::Zero();
    for (const int v : soup.face(f)) centre += soup.points.row(v) / 3;
    if (keep(f, centre)) out.add_face(soup.face(f));
  }
  return out;
}

/// Faces for which `turn(face)` holds run the other way.
template <class Turn>
PolygonSoup turned(const PolygonSoup& soup, const Turn& turn) {
  PolygonSoup out;
  out.points = soup.points;
  for (int f = 0; f < soup.n_faces(); ++f) {
    std::vector<int> face(soup.face(f).begin(), soup.face(f).end());
    if (turn(f)) std::reverse(face.begin(), face.end());
    out.add_face(face);
  }
  return out;
}

inline PolygonSoup reversed(const PolygonSoup& soup) {
  return turned(soup, [](int) { return true; });
}

inline PolygonSoup joined(const PolygonSoup& a, const PolygonSoup& b) {
  PolygonSoup out = a;
  out.points.resize(a.n_vertices() + b.n_vertices(), 3);
  out.points << a.points, b.points;
  for (int f = 0; f < b.n_faces(); ++f) {
    std::vector<int> face(b.face(f).begin(), b.face(f).end());
    for (int& v : face) v += a.n_vertices();
    out.add_face(face);
  }
  return out;
}

/// The half of an octasphere below z = 0, and its closing by a flat fan.
inline PolygonSoup hemisphere(int level, bool closed) {
  PolygonSoup soup = part_of(octasphere_soup(level), [](int, const Vec3& c) { return c[2] < 0; });
  if (!closed) return soup;
  const auto rim = boundary_edges(soup.points, triangles_of(soup));
  soup.points.conservativeResize(soup.n_vertices() + 1, 3);
  soup.points.row(soup.n_vertices() - 1).setZero();
  for (const auto& [a, b] : rim) add_triangle(soup, b, a, soup.n_vertices() - 1);
  return soup;
}

}  // namespace littoral::test
