#pragma once
// Distance to a surface in space that may have holes: complete it first, then measure.

#include <memory>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/volume.h"
#include "methods/implicit/level_patch.h"
#include "methods/implicit/pointwise.h"
#include "methods/implicit/settled_sides.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

/// Distance to an input and to what completes it, negative inside.
class CompletedDistance : public PointwiseDistance {
 public:
  /// At the nodes of a grid. May report where the sign is doubtful.
  virtual VecX at_nodes(const Grid& grid, const Task& task, Report& report) const = 0;
  /// Over holes; none where the input is closed.
  virtual const LevelPatch& patch() const = 0;
};

/// Distance to the nearest point of a surface and of the patches over its holes, negative inside:
/// exact around closed surfaces.
///
/// Inside is where the winding number exceeds 1/2, as in Barill et al. (2018); patches are the set
/// where it equals 1/2 away from the surface (`level_patch`), so the distance vanishes where the
/// sign changes. Closed surfaces need none. What the surface's own winding number says about its
/// orientation is reported, with warnings where the sign is doubtful.
class CompletedSurface final : public CompletedDistance {
 public:
  /// points: n x 3, about unit size; faces: m x 3, with finite corners and an area; spacing: of the
  /// places that will be asked, patches are as fine; as_given: inside is behind the normals even
  /// where the surface encloses the other side.
  CompletedSurface(const MatX3& points, const MatX3i& faces, double spacing, bool as_given,
                   const Task& task, Report& report);

  DistanceSample at(const Vec3& x) const override;
  double value_after(const Vec3& x, int& last) const override;
  VecX on_grid(const Grid& grid, const Task& task) const override;

  /// Reports where the sign changes without a surface between two nodes.
  VecX at_nodes(const Grid& grid, const Task& task, Report& report) const override;
  const LevelPatch& patch() const override { return patch_; }

 private:
  bool is_inside(const Vec3& x) const;

  SettledSides sides_;
  bool closed_;
  LevelPatch patch_;
  std::unique_ptr<TriangleBvh> bvh_;  // faces, then those of the patch
  MatX3 normals_;                     // of these
};

}  // namespace littoral
