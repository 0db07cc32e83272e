#pragma once
// Tet meshes with known distances.

#include "littoral/polygon_soup.h"
#include "littoral/tet_mesh.h"
#include "test_meshes.h"

namespace littoral::test {

/// n copies of a mesh, each that much further than the last, not connected.
inline TetMesh copies(const TetMesh& one, int n, const Eigen::RowVector3d& apart) {
  TetMesh all;
  const int nv = one.n_vertices(), nt = one.n_tets();
  all.points.resize(n * nv, 3);
  all.tets.resize(n * nt, 4);
  for (int c = 0; c < n; ++c) {
    all.points.middleRows(c * nv, nv) = one.points.rowwise() + c * apart;
    all.tets.middleRows(c * nt, nt) = one.tets.array() + c * nv;
  }
  return all;
}

/// The square x = x0 of the unit cube in n x n cells, its normals along +x, each cut along the
/// diagonal that tet_box(n) has there.
inline PolygonSoup square_at(double x0, int n) {
  PolygonSoup soup;
  soup.points.resize((n + 1) * (n + 1), 3);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      soup.points.row(j + (n + 1) * k) << x0, double(j) / n, double(k) / n;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j) {
      const int a = j + (n + 1) * k, b = a + 1, c = a + n + 2, d = a + n + 1;
      const int lower[3] = {a, b, c}, upper[3] = {a, c, d};
      soup.add_face(lower);
      soup.add_face(upper);
    }
  return soup;
}

}  // namespace littoral::test
