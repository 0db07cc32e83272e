#include "spatial/pseudonormals.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "spatial/boundary_edges.h"

namespace littoral {

MatX3 face_normals(const MatX3& points, const MatX3i& faces) {
  MatX3 normals = MatX3::Zero(faces.rows(), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
               c = points.row(faces(f, 2));
    const Vec3 n = (b - a).cross(c - a).stableNormalized();
    if (n.allFinite()) normals.row(f) = n;
  }
  return normals;
}

Pseudonormals::Pseudonormals(const MatX3& points, const MatX3i& faces)
    : faces_(faces), vertex_(same_positions(points)), normals_(face_normals(points, faces)) {
  at_vertex_ = MatX3::Zero(points.rows(), 3);
  end_.assign(points.rows(), 0);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    std::array<Vec3, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = points.row(faces(f, k));
    const Vec3 n = normals_.row(f);
    if (n.isZero(0)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      at_vertex_.row(vertex(f, k)) += angle * n;
      Side& side = at_edge_[edge_key(f, k)];
      side.normal += n;
      ++side.faces;
      side.forward += vertex(f, k) < vertex(f, (k + 1) % 3) ? 1 : -1;
    }
  }
  for (const auto& [ends, side] : at_edge_) {
    if (side.forward == 0) continue;
    end_[ends.first] = end_[ends.second] = 1;
    oriented_ = oriented_ && side.faces == 1;
  }
}

std::pair<int, int> Pseudonormals::place(const NearestPoint& foot) {
  constexpr double rounding = 1e-10;
  int zeros = 0, zero = -1, one = -1;
  for (int k = 0; k < 3; ++k) {
    if (foot.barycentric[k] <= rounding) {
      ++zeros;
      zero = k;
    } else {
      one = k;
    }
  }
  return {zeros == 2 ? one : -1, zeros == 1 ? zero : -1};
}

Vec3 Pseudonormals::at(const NearestPoint& foot) const {
  const auto [corner, opposite] = place(foot);
  if (corner >= 0) return at_vertex_.row(vertex(foot.face, corner));
  if (opposite >= 0)
    if (const auto edge = at_edge_.find(edge_key(foot.face, (opposite + 1) % 3));
        edge != at_edge_.end())
      return edge->second.normal;
  return normals_.row(foot.face);
}

bool Pseudonormals::at_end(const NearestPoint& foot) const {
  const auto [corner, opposite] = place(foot);
  if (corner >= 0) return end_[vertex(foot.face, corner)] != 0;
  if (opposite < 0) return false;
  const auto edge = at_edge_.find(edge_key(foot.face, (opposite + 1) % 3));
  return edge != at_edge_.end() && edge->second.forward != 0;
}

}  // namespace littoral
