#pragma once
// What all distances in space begin with: the input moved to the origin, scaled and sampled.

#include <cmath>
#include <limits>

#include "api/space/sdf.h"
#include "api/space/space_method.h"

namespace littoral {

/// The smallest axis-aligned box of some points; empty at first.
struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  Vec3 size() const { return high - low; }
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// Of the faces or, without any, of the points. Throws InputError for an input without either, and
/// for coordinates that are not finite.
Box bounding_box(const PolygonSoup& input);

/// Moves the input to the origin and scales it to about unit size, by a power of two: results are
/// the same bits wherever it was and however large.
struct Frame {
  Vec3 centre;
  double unit;  // [length] of one unit

  explicit Frame(const Box& box) : centre(box.low + box.size() / 2), unit(1) {
    const double longest = box.size().maxCoeff();
    if (longest > 0) unit = std::exp2(std::ceil(std::log2(longest)));
  }
  Vec3 local(const Vec3& p) const { return (p - centre) / unit; }
  Grid local(const Grid& grid) const { return {grid.n, local(grid.origin), grid.spacing / unit}; }
  MatX3 local(const MatX3& p) const { return (p.rowwise() - centre.transpose()) / unit; }
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

/// The problem in the frame's units: triangles, or points with normals, and samples; faces are
/// sampled so that no side is longer than max_side. Throws InputError where there is nothing to
/// measure from.
SpaceProblem make_problem(const PolygonSoup& input, const SpaceRequest& request, const Frame& frame,
                          double max_side, Task& task, Report& report);

/// Throws InputError for a grid without two nodes along each axis, a box that is not finite or too
/// many nodes, IoError if computing on it will not fit into memory.
void check_grid(const Grid& grid);

/// The box of the input; throws InputError unless it meets that of the grid, and as check_grid.
Box box_on_grid(const PolygonSoup& input, const Grid& grid);

}  // namespace littoral
