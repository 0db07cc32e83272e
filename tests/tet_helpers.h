#pragma once
// Tet meshes with known distances.

#include <cmath>
#include <functional>
#include <vector>

#include "constants.h"
#include "littoral/polygon_soup.h"
#include "littoral/tet_mesh.h"
#include "one_call.h"
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

inline VecX automatic_tets(const TetMesh& mesh, const TetSources& sources, Report& report) {
  return tet_mesh_distance(mesh, sources, {}, report);
}
inline VecX automatic_tets(const TetMesh& mesh, const TetSources& sources) {
  Report report;
  return automatic_tets(mesh, sources, report);
}

/// What of tet_box(n) lies in cells that `keep` wants by their centres.
inline TetMesh tets_where(int n, const std::function<bool(const Vec3&)>& keep) {
  TetMesh mesh = tet_box(n);
  std::vector<int> kept;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    Vec3 low = Vec3::Ones(), high = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      low = low.cwiseMin(mesh.points.row(mesh.tets(t, k)).transpose());
      high = high.cwiseMax(mesh.points.row(mesh.tets(t, k)).transpose());
    }
    if (keep((low + high) / 2)) kept.push_back(t);
  }
  mesh.tets = Rows<int, 4>(mesh.tets(kept, Eigen::all));
  return mesh;
}

inline std::vector<char> used_vertices(const TetMesh& mesh) {
  std::vector<char> used(static_cast<std::size_t>(mesh.n_vertices()), 0);
  for (const int v : mesh.tets.reshaped()) used[v] = 1;
  return used;
}

inline int tet_vertex_at(const TetMesh& mesh, const Vec3& x) {
  Eigen::Index v = 0;
  (mesh.points.rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff(&v);
  return static_cast<int>(v);
}

/// Largest and mean error where there is a mesh.
struct TetErrors {
  double largest = 0, mean = 0;
};
inline TetErrors tet_errors(const TetMesh& mesh, const VecX& phi,
                            const std::function<double(const Vec3&)>& exact) {
  TetErrors out;
  int n = 0;
  const std::vector<char> used = used_vertices(mesh);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    if (used[v] == 0) continue;
    const double error = std::abs(phi[v] - exact(mesh.points.row(v)));
    out.largest = std::isnan(error) ? infinity : std::max(out.largest, error);
    out.mean += error;
    ++n;
  }
  out.mean /= n;
  return out;
}

}  // namespace littoral::test
