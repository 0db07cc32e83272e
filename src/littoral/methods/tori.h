#pragma once
// Points as tori: signed distance to an oriented point cloud, at any point (thesis, chapter 5).

#include <vector>

#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/methods/pointwise.h"
#include "littoral/methods/torus_fit.h"
#include "littoral/sources/oriented_points.h"
#include "littoral/spatial/point_tree.h"
#include "littoral/spatial/winding_number.h"

namespace littoral {

/// A cloud's tori and their blend; immutable, may be asked from several threads.
class Tori final : public PointwiseDistance {
 public:
  /// Fits a torus to each point. Coincident points become one with their mean normal; where normals
  /// cancel the point is left out, with a warning. Throws InputError if a number is not finite
  /// (naming the point), a normal is zero, or nothing remains.
  Tori(const OrientedPoints& cloud, const TorusFit& fit, const Task& task, Report& report);

  /// Tori fitted before, at their points (points x 3).
  Tori(MatX3 points, std::vector<Torus> tori);

  int size() const { return tree_.size(); }
  const MatX3& points() const { return points_; }
  const std::vector<Torus>& tori() const { return tori_; }

  /// Signed distance at x [length] (eq. 5.1 with shifted exponents): tori of the nearest points,
  /// each within its patch, weighted by how near their points are, relative to the spacing there.
  /// Never more than the distance to the nearest point. Away from the points, where tori disagree
  /// on the side (as behind acute edges) or the winding number of the cloud is certain that they
  /// are wrong (as beyond a few flipped normals), the winding number decides.
  double value(const Vec3& x) const override;

  /// The same with its derivative, exact but where neighbours or side change.
  DistanceSample at(const Vec3& x) const override;

 private:
  MatX3 points_;
  std::vector<Torus> tori_;
  PointTree tree_;
  WindingNumber winding_;
  int orientation_;  // 1 outward, -1 inward, 0 neither
};

}  // namespace littoral
