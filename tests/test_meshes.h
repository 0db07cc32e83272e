#pragma once
// Meshes made in code, for tests with known answers.

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "domain/mesh/surface_mesh.h"
#include "littoral/tet_mesh.h"

namespace littoral::test {

inline void add_triangle(PolygonSoup& soup, int a, int b, int c) {
  const int face[3] = {a, b, c};
  soup.add_face(face);
}

/// (nx+1) x (ny+1) vertices over [0,1]^2 in the plane z = 0; vertex i + j (nx+1) at (i/nx, j/ny).
/// `diagonal`: 0 all one way, 1 alternating (union jack).
inline PolygonSoup grid_soup(int nx, int ny, int diagonal = 0) {
  PolygonSoup soup;
  soup.points.resize((nx + 1) * (ny + 1), 3);
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      soup.points.row(i + j * (nx + 1)) << double(i) / nx, double(j) / ny, 0;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = i + j * (nx + 1), b = a + 1, c = a + nx + 1, d = c + 1;
      if (diagonal == 1 && (i + j) % 2) {
        add_triangle(soup, a, b, c);
        add_triangle(soup, b, d, c);
      } else {
        add_triangle(soup, a, b, d);
        add_triangle(soup, a, d, c);
      }
    }
  }
  return soup;
}

/// Moves the interior vertices of a grid at random by up to `amount` cells (seeded).
inline PolygonSoup jittered_grid_soup(int nx, int ny, double amount, unsigned seed = 1) {
  PolygonSoup soup = grid_soup(nx, ny, 1);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-amount, amount);
  for (int j = 1; j < ny; ++j)
    for (int i = 1; i < nx; ++i) {
      soup.points(i + j * (nx + 1), 0) += u(random) / nx;
      soup.points(i + j * (nx + 1), 1) += u(random) / ny;
    }
  return soup;
}

/// The unit cube in n^3 cubes of six tets each around their diagonals.
inline TetMesh tet_box(int n) {
  TetMesh mesh;
  const int m = n + 1;
  mesh.points.resize(m * m * m, 3);
  auto id = [m](int i, int j, int k) { return i + m * (j + m * k); };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        mesh.points.row(id(i, j, k)) << double(i) / n, double(j) / n, double(k) / n;
  mesh.tets.resize(6 * n * n * n, 4);
  int t = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int path[6][2] = {{1, 2}, {1, 4}, {2, 1}, {2, 4}, {4, 1}, {4, 2}};
        auto corner = [&](int bits) {
          return id(i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2));
        };
        for (const auto& p : path)
          mesh.tets.row(t++) << corner(0), corner(p[0]), corner(p[0] | p[1]), corner(7);
      }
  return mesh;
}

/// Octahedron refined `level` times, on the unit sphere; 8 * 4^level faces. The equator z = 0 and
/// the two other coordinate circles run along edges.
inline PolygonSoup octasphere_soup(int level) {
  PolygonSoup soup;
  soup.points.resize(6, 3);
  soup.points << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  const int faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                           {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (const auto& f : faces) soup.add_face(f);
  for (int l = 0; l < level; ++l) {
    PolygonSoup fine;
    std::vector<Vec3> points;
    for (int v = 0; v < soup.n_vertices(); ++v) points.emplace_back(soup.points.row(v));
    std::map<std::pair<int, int>, int> middle;
    auto mid = [&](int a, int b) {
      const auto key = std::minmax(a, b);
      const auto [it, added] = middle.try_emplace(key, static_cast<int>(points.size()));
      if (added) points.push_back((points[a] + points[b]).normalized());
      return it->second;
    };
    for (int f = 0; f < soup.n_faces(); ++f) {
      const auto c = soup.face(f);
      const int x = mid(c[0], c[1]), y = mid(c[1], c[2]), z = mid(c[2], c[0]);
      add_triangle(fine, c[0], x, z);
      add_triangle(fine, x, c[1], y);
      add_triangle(fine, z, y, c[2]);
      add_triangle(fine, x, y, z);
    }
    fine.points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t v = 0; v < points.size(); ++v)
      fine.points.row(static_cast<Eigen::Index>(v)) = points[v];
    soup = std::move(fine);
  }
  return soup;
}

/// Torus of radii R, r with nu x nv quads split in two.
inline PolygonSoup torus_soup(int nu, int nv, double R = 1, double r = 0.4) {
  PolygonSoup soup;
  soup.points.resize(nu * nv, 3);
  const double turn = 2 * std::acos(-1.0);
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const double u = turn * i / nu, v = turn * j / nv, s = R + r * std::cos(v);
      soup.points.row(i * nv + j) << s * std::cos(u), s * std::sin(u), r * std::sin(v);
    }
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const int a = i * nv + j, b = ((i + 1) % nu) * nv + j;
      const int c = ((i + 1) % nu) * nv + (j + 1) % nv, d = i * nv + (j + 1) % nv;
      add_triangle(soup, a, b, c);
      add_triangle(soup, a, c, d);
    }
  return soup;
}

/// Pages of n x n squares of one unit that share the spine x = y = 0, `turn` radians from one to
/// the next, two triangles a square, page after page. Vertices are numbered along the spine first.
inline PolygonSoup book_soup(int pages, int n, double turn) {
  PolygonSoup soup;
  soup.points.resize((n + 1) * (1 + pages * n), 3);
  const auto vertex = [n](int page, int i, int j) {
    return i == 0 ? j : (n + 1) * (1 + page * n + i - 1) + j;
  };
  for (int page = 0; page < pages; ++page)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        soup.points.row(vertex(page, i, j)) << std::cos(turn * page) * i / n,
            std::sin(turn * page) * i / n, double(j) / n;
  for (int page = 0; page < pages; ++page)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        add_triangle(soup, vertex(page, i, j), vertex(page, i + 1, j), vertex(page, i + 1, j + 1));
        add_triangle(soup, vertex(page, i, j), vertex(page, i + 1, j + 1), vertex(page, i, j + 1));
      }
  return soup;
}

}  // namespace littoral::test
