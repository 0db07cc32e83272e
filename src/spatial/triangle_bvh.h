#pragma once
// Closest point on a triangle soup: a bounding-volume hierarchy in flat arrays.

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "littoral/volume.h"
#include "spatial/bound_node.h"
#include "spatial/closest_on_triangle.h"
#include "spatial/nearest_kernels.h"

namespace littoral {

/// Answer of a closest-point query.
struct NearestPoint {
  int face = -1;
  std::array<double, 3> barycentric{1, 0, 0};  // per corner of the face, in [0, 1], sum 1
  Vec3 point = Vec3::Zero();                   // on the face
  double distance = 0;                         // |point - query|
};

/// Bounding-volume hierarchy over triangles; immutable, queries may run from several threads.
///
/// Triangles may be degenerate, repeated or unconnected; those with a non-finite corner are left
/// out, and those that add nothing to the others (spatial/covered_triangles.h). Coordinates are
/// scaled by a power of two inside, so any magnitude up to 1e300 works. Split by surface area
/// (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007: binned), by count
/// where that fails to divide; then eight boxes and disks to a node, down to groups of up to eight
/// triangles.
class TriangleBvh {
 public:
  /// points: n x 3; faces: m x 3, rows index points. Throws InputError if an index is out of range
  /// (naming the face) or no face has three finite corners.
  TriangleBvh(const MatX3& points, const MatX3i& faces);

  /// Nearest point over all faces, the lowest face where several are equally near, but never a copy
  /// of another or one without area on a side or corner of another. A query beyond
  /// 1e60 times the size of the coordinates sees only the direction of the faces. `hint` is a face
  /// that may be near, such as that of the query before, or -1: it changes the time, not the
  /// answer. Throws InputError if the query is not finite.
  NearestPoint closest_point(const Vec3& query, int hint = -1) const;

  /// The distances of closest_point at all nodes of a grid, whole blocks of them at once: the same
  /// numbers, but for rounding where several faces are equally near. On all threads.
  VecX distances(const Grid& grid, const Task& task) const;
  /// The same with the nearest points, whose faces too may be others where several are equally
  /// near: what `value` makes of the place of a node and the point nearest to it.
  using NodeValue = std::function<double(const Vec3& x, const NearestPoint& nearest)>;
  VecX values_at_nodes(const Grid& grid, const NodeValue& value, const Task& task) const;

 private:
  class BlockSearch;
  struct Box {
    Vec3 low, high;
  };
  struct Split {
    Box box;
    int begin = 0, end = 0;  // into `order`
    int child = -1;          // the left one, the right one follows it; -1: a group of triangles
  };
  static constexpr int width = bound_lanes;
  static std::vector<Split> split(const std::vector<Box>& boxes, std::vector<int>& order);
  /// Stored triangles looked at together: [begin, end), at most `nearest_lanes`.
  struct Group {
    int begin = 0, end = 0;
  };
  /// Stored triangles [begin, end) of the children of a node; none in empty lanes.
  using Lanes = std::array<std::pair<int, int>, width>;
  int add_node(const std::vector<Split>& splits, int root, std::vector<Lanes>& ranges);

  Vec3 to_tree(const Vec3& query) const;  // coordinates as they are stored
  double distance_to(int stored, const Vec3& query) const;
  NearestPoint nearest_on(int stored, const Vec3& query) const;
  NearestPoint point_of(int stored, const TriangleFoot& foot, int exponent) const;
  /// At the nodes of a grid; distances without a `value`.
  VecX by_blocks(const Grid& grid, const NodeValue* value, const Task& task) const;

  int exponent_ = 0;                   // stored coordinates = coordinates * 2^-exponent
  Vec3 centre_ = Vec3::Zero();         // nodes: coordinates about it,
  double unit_ = 1;                    // in these units
  std::vector<SmallBoundNode> nodes_;  // child: another node, or -1 - (group)
  std::vector<Group> groups_;
  std::vector<CornerLanes> lanes_;            // corners of each group in the nodes' coordinates
  std::vector<int> faces_;                    // original number of each stored triangle
  std::vector<int> group_of_;                 // of each original one, or -1
  std::vector<std::array<Vec3, 3>> corners_;  // scaled, in the order of the tree
};

}  // namespace littoral
