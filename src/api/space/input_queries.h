#pragma once
// What an input itself says at points in space: where it is nearest, how often it winds around, and
// how sure inside and outside are.

#include <memory>
#include <vector>

#include "api/space/frame.h"
#include "base/lazy.h"
#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/space.h"
#include "methods/implicit/settled_sides.h"
#include "spatial/point_tree.h"
#include "spatial/triangle_bvh.h"
#include "spatial/winding_number.h"

namespace littoral {

/// The nearest points of a surface, or of a cloud where the soup has no faces; immutable.
class NearestOnInput {
 public:
  /// Throws InputError where there is nothing, or for coordinates that are not finite.
  explicit NearestOnInput(const PolygonSoup& input);
  /// Of points (queries x 3), finite.
  NearestPoints at(const MatX3& queries, const Task& task) const;

 private:
  MatX3 points_;              // of a cloud
  MatX3i corners_;            // triangles x 3: vertices of the input
  std::vector<int> face_of_;  // triangles: faces of the input
  std::unique_ptr<const TriangleBvh> triangles_;
  std::unique_ptr<const PointTree> cloud_;
};

/// Winding numbers around a surface or oriented cloud at points (queries x 3), convolved with a
/// Gaussian of deviation `sigma` [length].
VecX smoothed_winding(const PolygonSoup& input, const Orientation& orientation, double sigma,
                      const MatX3& queries, Task task, Report& report);

/// Generalized winding numbers around a surface or oriented cloud; immutable.
class WindingOfInput {
 public:
  /// Throws as make_input (api/space/space_input.h).
  WindingOfInput(const PolygonSoup& input, const Orientation& orientation, Task task,
                 Report& report);
  /// At points (queries x 3), finite.
  VecX at(const MatX3& queries, const Task& task) const;
  /// How sure inside and outside are at points (queries x 3), finite: 1 where the winding number,
  /// of faces turned where their orientation disagrees, is that of the inside or of the outside of
  /// a closed surface, 0 where it is half way between them.
  VecX confidence(const MatX3& queries, const Task& task) const;

 private:
  Frame frame_;
  std::unique_ptr<const WindingNumber> winding_;
  MatX3 points_{0, 3};  // of a surface
  MatX3i triangles_{0, 3};
  bool flipped_;
  Kept<SettledSides> sides_;
};

}  // namespace littoral
