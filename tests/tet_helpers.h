#pragma once
// Tet meshes with known distances.

#include <algorithm>
#include <array>
#include <string>

#include "littoral/domain/polygon_soup.h"
#include "littoral/domain/tet_mesh.h"

namespace littoral::test {

/// The unit cube in n^3 cells of six tets each, all along the same diagonal.
inline TetMesh cube_tets(int n) {
  TetMesh mesh;
  const auto vertex = [n](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  mesh.points.resize((n + 1) * (n + 1) * (n + 1), 3);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        mesh.points.row(vertex(i, j, k)) << double(i) / n, double(j) / n, double(k) / n;
  mesh.tets.resize(6 * n * n * n, 4);
  int t = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        std::array<int, 3> axes{0, 1, 2};
        do {  // a path from corner to corner along each order of the axes
          std::array<int, 3> at{i, j, k};
          mesh.tets(t, 0) = vertex(i, j, k);
          for (int s = 0; s < 3; ++s) {
            ++at[static_cast<std::size_t>(axes[static_cast<std::size_t>(s)])];
            mesh.tets(t, s + 1) = vertex(at[0], at[1], at[2]);
          }
          ++t;
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  return mesh;
}

/// The square x = x0 of the unit cube in n x n cells, its normals along +x, each cut along the
/// diagonal that cube_tets(n) has there.
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
