#pragma once
// Points as tori: signed distance to an oriented point cloud, at any point (thesis, chapter 5).

#include <array>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "methods/implicit/pointwise.h"
#include "methods/tori/jet.h"
#include "methods/tori/torus_fit.h"
#include "methods/tori/torus_kernels.h"
#include "sources/space/oriented_points.h"
#include "spatial/point_tree.h"
#include "spatial/winding_number.h"

namespace littoral {

/// How the blend is summed.
enum class ToriPrecision { full, single };

/// What becomes of points that hardly any neighbour agrees with (sources/space/likely_outliers.h).
enum class ToriOutliers { keep, drop };

/// A cloud's tori and their blend; immutable, may be asked from several threads.
class ToriDistance final : public PointwiseDistance {
 public:
  /// Fits a torus to each point. Coincident points become one with their mean normal; where normals
  /// cancel the point is left out, with a warning. Throws InputError if a number is not finite
  /// (naming the point), a normal is zero, or nothing remains.
  ToriDistance(const OrientedPoints& cloud, const TorusFit& fit, const Task& task, Report& report,
               ToriPrecision precision = ToriPrecision::full,
               ToriOutliers outliers = ToriOutliers::keep);

  /// Tori fitted before, at their points (points x 3).
  ToriDistance(MatX3 points, std::vector<Torus> tori,
               ToriPrecision precision = ToriPrecision::full);

  int size() const { return tree_.size(); }
  const MatX3& points() const { return points_; }
  const std::vector<Torus>& tori() const { return tori_; }

  /// Signed distance at x [length] (eq. 5.1 with shifted exponents): tori of the nearest points,
  /// each within its patch, weighted by how near their points are, relative to the spacing there.
  /// Never more than the distance to the nearest point. Away from the points, where tori disagree
  /// on the side (as behind acute edges) or the winding number of the cloud is certain that they
  /// are wrong (as beyond a few flipped normals), the winding number decides. In single precision
  /// it is precise to about 1e-6 of the distance where tori agree; half the memory.
  double value(const Vec3& x) const override;

  /// The same with its derivative, exact but where neighbours or side change.
  DistanceSample at(const Vec3& x) const override;

  /// With its Laplacian [1 / length] too: twice the mean curvature of the level through x.
  Jet jet(const Vec3& x) const;

  /// The value by plain sums, one torus after the other and always by the winding number's side:
  /// what `value` is tested against.
  double value_by_plain_sums(const Vec3& x) const;

 private:
  ToriDistance(MatX3 points, std::vector<Torus> tori, PointTree tree, ToriPrecision precision);
  void find_trusted();
  bool trusted(const Neighbour& nearest, const Vec3& x, bool negative) const;
  int side_of(const Vec3& x, bool negative, bool disputed) const;
  template <class T, class S>
  T blended(const std::vector<TorusRecord<S>>& records, const Vec3& x) const;
  template <class T>
  T plain(const Vec3& x, const std::array<T, 3>& at) const;

  MatX3 points_;
  std::vector<Torus> tori_;
  PointTree tree_;                            // names places
  std::vector<int> order_;                    // place -> point; neighbours have neighbouring places
  std::vector<TorusRecord<double>> records_;  // by place; one of the two
  std::vector<TorusRecord<float>> single_;
  WindingNumber winding_;
  int orientation_;                     // 1 outward, -1 inward, 0 neither
  std::vector<unsigned char> trusted_;  // per group of places: normals point the right way
};

}  // namespace littoral
