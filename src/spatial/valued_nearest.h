#pragma once
// Nearest of sources that distance is counted from values of.

#include <vector>

#include "littoral/types.h"
#include "spatial/cluster_tree.h"

namespace littoral {

/// Where a value plus or minus a distance is least or greatest.
struct ValuedPoint {
  double reach = 0;           // c + d or c - d
  double distance = 0;        // d
  Vec3 point = Vec3::Zero();  // on the source
  int source = -1;
};

/// Triangles or points, each with a value c: the additively weighted nearest of them. Immutable,
/// queries may run from several threads.
///
/// A tree of boxes by medians, each with the least and the greatest value in it: no source in a box
/// reaches a query for less than the least value plus the distance to the box. Around points, the
/// level set of value 0 of the least is the union of the balls of radius -c.
class ValuedNearest {
 public:
  /// points: n x 3, finite, about unit size; faces: m x 3, rows index points, or none: the points
  /// are the sources; values: one for each source, finite.
  ValuedNearest(const MatX3& points, const MatX3i& faces, std::vector<double> values);

  /// The least of c + d.
  ValuedPoint least(const Vec3& x) const { return best(x, 1); }
  /// The greatest of c - d.
  ValuedPoint greatest(const Vec3& x) const { return best(x, -1); }

 private:
  ValuedPoint best(const Vec3& x, int sign) const;
  double bound(std::size_t box, const Vec3& x, int sign) const;
  Vec3 way_to(int source, const Vec3& x) const;

  MatX3 points_;
  MatX3i faces_;
  std::vector<double> values_;
  ClusterTree tree_;
  MatX3 low_, high_;                      // of the clusters
  std::vector<double> least_, greatest_;  // values in them
};

}  // namespace littoral
