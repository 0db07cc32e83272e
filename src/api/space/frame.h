#pragma once
// Inputs in space are moved to the origin and scaled to about unit size before anything is
// computed.

#include <cmath>
#include <vector>

#include "base/index.h"
#include "littoral/types.h"
#include "littoral/volume.h"
#include "methods/tori/torus.h"

namespace littoral {

/// The smallest axis-aligned box of some points; empty at first.
struct Box {
  Vec3 low = Vec3::Constant(infinity);
  Vec3 high = -low;
  Vec3 size() const { return high - low; }
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// Moves a box to the origin and scales it to about unit size, by a power of two: results are the
/// same bits wherever it was and however large.
struct Frame {
  Vec3 centre;
  double unit = 1;     // [length] of one unit
  double longest = 1;  // side of the box in units; 1 if it has none

  explicit Frame(const Box& box) : centre(box.low + box.size() / 2) {
    const double side = box.size().maxCoeff();
    if (!(side > 0)) return;
    unit = std::exp2(std::ceil(std::log2(side)));
    longest = side / unit;
  }
  /// How fine a mesh is sampled for points that have no grid, in units: the same part of it however
  /// large it is.
  double query_side() const { return 0.0125 * longest; }
  Vec3 local(const Vec3& p) const { return (p - centre) / unit; }
  Grid local(const Grid& grid) const { return {grid.n, local(grid.origin), grid.spacing / unit}; }
  MatX3 local(const MatX3& p) const { return (p.rowwise() - centre.transpose()) / unit; }
  std::vector<double> local(std::vector<double> lengths) const {
    for (double& length : lengths) length /= unit;
    return lengths;
  }
  MatX3 global(const MatX3& p) const { return (unit * p).rowwise() + centre.transpose(); }
  Torus local(Torus t) const { return scaled(t, local(t.q), 1 / unit); }
  Torus global(Torus t) const { return scaled(t, centre + unit * t.q, unit); }

 private:
  static Torus scaled(Torus t, const Vec3& q, double scale) {
    t.q = q;
    t.k1 /= scale;
    t.k2 /= scale;
    t.rho *= scale;
    return t;
  }
};

}  // namespace littoral
