#pragma once
// One shape on every discretization.

#include <Eigen/Geometry>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "domain/volume/voxels.h"
#include "one_call.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral::test {

enum class Domain { triangles, polygons, points, voxels };

inline std::ostream& operator<<(std::ostream& out, Domain domain) {
  return out << std::array{"triangles", "polygons", "points", "voxels"}[int(domain)];
}

/// A surface as any of them: voxels have normals of their faces.
struct Shape {
  PolygonSoup soup;
  MatX3 face_normals{0, 3};

  VecX distance(const Sources& sources, const std::string& method, const OptionValues& options = {},
                Report* report = nullptr) const {
    Report own;
    return surface_distance(SurfaceMesh(soup), sources, AnyMethod::named(method, options),
                            report ? *report : own, face_normals.rows() ? &face_normals : nullptr);
  }
};

/// Quads of an n_u x n_v grid whose index in the first direction wraps around; `at(i, j)` numbers
/// the nodes. A quad whose first or last side is a pole is a triangle.
template <class At>
void add_quads(PolygonSoup& soup, int n_u, int n_v, const At& at) {
  for (int i = 0; i < n_v; ++i)
    for (int j = 0; j < n_u; ++j) {
      const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (a == d)
        add_triangle(soup, a, b, c);
      else if (b == c)
        add_triangle(soup, a, b, d);
      else
        soup.add_face(std::array{a, b, c, d});
    }
}

/// The boundary of the voxels whose centres are inside; a cube of `width` voxels about the origin.
template <class Inside>
Shape digitized(int width, double spacing, const Inside& inside) {
  Grid grid;
  grid.n = {width, width, width};
  grid.spacing = Vec3::Constant(spacing);
  grid.origin = Vec3::Constant(-0.5 * (width - 1) * spacing);
  std::vector<unsigned char> mask(grid.n_nodes());
  for (int k = 0; k < width; ++k)
    for (int j = 0; j < width; ++j)
      for (int i = 0; i < width; ++i) mask[grid.node(i, j, k)] = inside(grid.point(i, j, k));
  const VoxelSurface voxels = boundary_of_voxels(grid, mask);
  return {voxels.mesh.soup(), voxels.face_normals};
}

/// Unit sphere with about 2 n^2 nodes (voxels 9 n^2 / 2).
inline Shape sphere(Domain domain, int n) {
  const double pi = std::acos(-1.0);
  if (domain == Domain::voxels)
    return digitized(n + 4, 2.0 / n, [](const Vec3& p) { return p.squaredNorm() < 1; });
  Shape shape;
  PolygonSoup& soup = shape.soup;
  if (domain == Domain::triangles) {
    int level = 0;
    while (4 << (2 * level) < 2 * n * n) ++level;
    soup = octasphere_soup(level);
  } else if (domain == Domain::polygons) {
    const int last = 1 + (n - 1) * 2 * n;
    soup.points.resize(last + 1, 3);
    auto at = [&](int i, int j) {
      return i == 0 ? 0 : i == n ? last : 1 + (i - 1) * 2 * n + j % (2 * n);
    };
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j < 2 * n; ++j) {
        const double t = pi * i / n, u = pi * j / n;
        soup.points.row(at(i, j)) << std::sin(t) * std::cos(u), std::sin(t) * std::sin(u),
            std::cos(t);
      }
    add_quads(soup, 2 * n, n, at);
  } else {
    const int count = 2 * n * n;
    soup.points.resize(count, 3);
    for (int i = 0; i < count; ++i) {
      const double z = 1 - 2 * (i + 0.5) / count, u = pi * (1 + std::sqrt(5.0)) * i;
      const double r = std::sqrt(1 - z * z);
      soup.points.row(i) << r * std::cos(u), r * std::sin(u), z;
    }
    soup.normals = soup.points;
  }
  return shape;
}

/// The torus of radii 1 and 0.4 about the z axis with n nodes around the tube and 5 n / 2 along it
/// (voxels 2.6 n^2); points are moved at random along the surface.
inline Shape torus(Domain domain, int n) {
  const double pi = std::acos(-1.0);
  if (domain == Domain::voxels)
    return digitized(static_cast<int>(0.98 * n) + 5, 1 / (0.35 * n), [](const Vec3& p) {
      return std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()) < 0.4;
    });
  const int m = 5 * n / 2;
  Shape shape;
  PolygonSoup& soup = shape.soup;
  soup.points.resize(m * n, 3);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> some(0, domain == Domain::points ? 0.3 : 0);
  auto at = [&](int i, int j) { return i % n * m + j % m; };
  MatX3 normals(m * n, 3);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double v = 2 * pi * (i + some(random)) / n, u = 2 * pi * (j + some(random)) / m;
      const double r = 1 + 0.4 * std::cos(v);
      soup.points.row(at(i, j)) << r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v);
      normals.row(at(i, j)) << std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v);
    }
  if (domain == Domain::points) {
    soup.normals = normals;
    return shape;
  }
  add_quads(soup, m, n, at);
  for (Eigen::Index f = 0; 4 * f < static_cast<Eigen::Index>(soup.corners.size()); ++f)
    std::swap(soup.corners[4 * f + 1], soup.corners[4 * f + 3]);  // outward
  if (domain == Domain::triangles) soup = triangulate(soup);
  return shape;
}

/// The unit square with (n + 1)^2 nodes, moved at random inside; voxels have no such thing.
inline Shape square(Domain domain, int n) {
  Shape shape;
  shape.soup = jittered_grid_soup(n, n, 0.25);
  if (domain == Domain::triangles) return shape;
  shape.soup.face_offsets = {0};
  shape.soup.corners.clear();
  if (domain == Domain::points) {
    shape.soup.normals = MatX3::Zero(shape.soup.n_vertices(), 3);
    shape.soup.normals.col(2).setOnes();
    return shape;
  }
  // Quads, and hexagons out of two of them.
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + j * (n + 1), d = a + n + 1;
      if ((i + 2 * j) % 5 == 0 && i + 1 < n) {
        shape.soup.add_face(std::array{a, a + 1, a + 2, d + 2, d + 1, d});
        ++i;
      } else {
        shape.soup.add_face(std::array{a, a + 1, d + 1, d});
      }
    }
  return shape;
}

}  // namespace littoral::test
