#pragma once
// One shape on every discretization.

#include <Eigen/Geometry>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "littoral/api/distance.h"
#include "littoral/domain/voxels.h"
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

  VecX distance(const SurfaceSources& sources, const std::string& method,
                const OptionTexts& options = {}, Report* report = nullptr,
                bool flip = false) const {
    Report own;
    return surface_distance(SurfaceMesh(soup), sources, {method, options, flip}, {},
                            report ? *report : own, face_normals.rows() ? &face_normals : nullptr);
  }
};

/// Unit sphere with about 2 n^2 nodes.
inline Shape sphere(Domain domain, int n) {
  const double pi = std::acos(-1.0);
  Shape shape;
  PolygonSoup& soup = shape.soup;
  if (domain == Domain::triangles) {
    int level = 0;
    while (4 << (2 * level) < 2 * n * n) ++level;
    soup = octasphere_soup(level);
  } else if (domain == Domain::polygons) {
    std::vector<Vec3> points{Vec3::UnitZ()};
    for (int i = 1; i < n; ++i)
      for (int j = 0; j < 2 * n; ++j) {
        const double t = pi * i / n, u = pi * j / n;
        points.emplace_back(std::sin(t) * std::cos(u), std::sin(t) * std::sin(u), std::cos(t));
      }
    points.push_back(-Vec3::UnitZ());
    const int last = static_cast<int>(points.size()) - 1;
    auto at = [&](int i, int j) {
      return i == 0 ? 0 : i == n ? last : 1 + (i - 1) * 2 * n + j % (2 * n);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2 * n; ++j) {
        if (i == 0)
          add_triangle(soup, 0, at(1, j), at(1, j + 1));
        else if (i + 1 == n)
          add_triangle(soup, at(i, j), last, at(i, j + 1));
        else
          soup.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    soup.points.resize(last + 1, 3);
    for (int v = 0; v <= last; ++v) soup.points.row(v) = points[v];
  } else if (domain == Domain::points) {
    const int count = 2 * n * n;
    soup.points.resize(count, 3);
    for (int i = 0; i < count; ++i) {
      const double z = 1 - 2 * (i + 0.5) / count, u = pi * (1 + std::sqrt(5.0)) * i;
      const double r = std::sqrt(1 - z * z);
      soup.points.row(i) << r * std::cos(u), r * std::sin(u), z;
    }
    soup.normals = soup.points;
  } else {
    Grid grid;
    const double radius = 0.5 * n;
    const int width = n + 4;
    grid.n = {width, width, width};
    grid.spacing = Vec3::Constant(1 / radius);
    grid.origin = Vec3::Constant(-0.5 * (width - 1) / radius);
    std::vector<unsigned char> inside(grid.n_nodes());
    for (int k = 0; k < width; ++k)
      for (int j = 0; j < width; ++j)
        for (int i = 0; i < width; ++i)
          inside[grid.node(i, j, k)] = grid.point(i, j, k).squaredNorm() < 1;
    const VoxelSurface voxels = boundary_of_voxels(grid, inside);
    soup = voxels.mesh.soup();
    shape.face_normals = voxels.face_normals;
  }
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
