#pragma once
// Normals of triangles, at their sides and corners too.

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "littoral/types.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

/// Of unit length, zero where a face has no area.
MatX3 face_normals(const MatX3& points, const MatX3i& faces);

/// Angle-weighted normals at corners, and sums of normals across edges (Baerentzen and Aanaes
/// 2005): which side of a closed, consistently oriented mesh a point lies on shows at the nearest
/// point. Vertices at one position count as one, so that soups whose faces share nothing but
/// positions work as well.
class Pseudonormals {
 public:
  Pseudonormals(const MatX3& points, const MatX3i& faces);

  /// Where the foot lies on a corner or side to within rounding, that one's normal.
  Vec3 at(const NearestPoint& foot) const;
  /// Whether the foot lies, likewise, where the surface ends or its orientation changes: at a side
  /// that faces do not run along as often in one direction as in the other.
  bool at_end(const NearestPoint& foot) const;
  /// Whether faces that share a side agree in orientation everywhere.
  bool oriented() const { return oriented_; }

 private:
  struct Side {
    Vec3 normal = Vec3::Zero();
    int faces = 0, forward = 0;  // how many run along it; those from the lower vertex, less others
  };
  /// What the foot lies on: the corner or, opposite a corner, the side; both -1: neither.
  static std::pair<int, int> place(const NearestPoint& foot);
  int vertex(Eigen::Index f, int k) const { return vertex_[faces_(f, k)]; }
  std::pair<int, int> edge_key(Eigen::Index f, int k) const {
    return std::minmax({vertex(f, k), vertex(f, (k + 1) % 3)});
  }

  MatX3i faces_;
  std::vector<int> vertex_;  // vertex -> the lowest at its position
  MatX3 normals_, at_vertex_;
  std::vector<char> end_;  // vertices
  std::map<std::pair<int, int>, Side> at_edge_;
  bool oriented_ = true;
};

}  // namespace littoral
