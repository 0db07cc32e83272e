#include "domain/mesh/flattened_voxels.h"

#include <algorithm>

#include "domain/mesh/nodal_surface.h"
#include "solve/direct/definite.h"

namespace littoral {

namespace {

constexpr double stay = 0.25;  // steps go within 4 voxels, edges of the solid stay

}  // namespace

PolygonSoup flattened_voxels(const SurfaceMesh& mesh, const MatX3& face_normals) {
  const int n = mesh.n_vertices();
  MatX3 normals = MatX3::Zero(n, 3);
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (const int v : mesh.face(f)) normals.row(v) += face_normals.row(f);
  for (auto row : normals.rowwise()) row = normalized_or_z(row.transpose()).transpose();
  const double size = mesh.points().size() ? mesh.points().cwiseAbs().maxCoeff() : 0;
  const double unit = size > 0 ? size : 1;  // squares of lengths leave the range of numbers
  Triplets entries;
  VecX b = VecX::Zero(n);
  for (int v = 0; v < n; ++v) entries.emplace_back(v, v, stay * stay);
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const int v = mesh.edges()(e, 0), w = mesh.edges()(e, 1);
    const Vec3 m = normalized_or_z((normals.row(v) + normals.row(w)).transpose());
    const double at_v = normals.row(v).dot(m), at_w = normals.row(w).dot(m);
    const double step = (mesh.point(w) / unit - mesh.point(v) / unit).dot(m);
    entries.emplace_back(v, v, at_v * at_v);
    entries.emplace_back(w, w, at_w * at_w);
    entries.emplace_back(std::max(v, w), std::min(v, w), -at_v * at_w);
    b[v] += at_v * step;
    b[w] -= at_w * step;
  }
  SpMat A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  const VecX h = DefiniteSystem(A, Task()).solve(b);
  PolygonSoup moved = mesh.soup();
  for (int v = 0; v < n; ++v) moved.points.row(v) += unit * h[v] * normals.row(v);
  return moved;
}

}  // namespace littoral
