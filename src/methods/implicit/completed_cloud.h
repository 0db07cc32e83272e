#pragma once
// Distance to an oriented cloud that may have holes and noise: complete it first, then measure.

#include <memory>

#include "methods/implicit/completed.h"
#include "methods/tori/tori.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

/// Distance to the zero set of a cloud's tori, negative inside.
///
/// Between the points of a cloud and over its holes the tori say where the surface runs, but far
/// from it they see no more than the nearest points: over holes and around noisy points they are
/// too large or too small. So their zero set is taken from a grid, as triangles, and distance is
/// measured to these: of clean clouds to those over holes, as tori are better elsewhere, of noisy
/// ones to all. What the triangles are off the zero set is added: the tori's value where the
/// nearest is met. Close by the tori themselves are asked, and wherever the nearest point is nearer
/// than any triangle, as around parts thinner than the grid's spacing.
class CompletedCloud final : public CompletedDistance {
 public:
  /// The grid must hold the points.
  CompletedCloud(std::unique_ptr<const ToriDistance> tori, const Grid& grid, const Task& task,
                 Report& report);

  DistanceSample at(const Vec3& x) const override;
  double value_after(const Vec3& x, int& last) const override;
  double value(const Vec3& x) const override;

  VecX at_nodes(const Grid& grid, const Task& task, Report& report) const override;
  /// The triangles more than a spacing and a half of the cloud from all points.
  const LevelPatch& patch() const override { return patch_; }

 private:
  struct Foot {
    double tori = 0;            // their value at x
    double distance = 0;        // of the triangles
    double off = 0;             // the zero set, from the nearest of these
    Vec3 point = Vec3::Zero();  // on it
    int face = -1;
    bool by_tori = true;  // nothing else knows
  };
  void measure_triangles(const MatX3& corners);
  /// The triangles more than so many spacings from all points.
  LevelPatch patch_beyond(double spacings, const MatX3& corners, const MatX3i& faces) const;
  Foot foot_of(const Vec3& x, double tori, int last) const;
  double combined(const Foot& foot) const;

  std::unique_ptr<const ToriDistance> tori_;
  PointTree points_;
  double spacing_;      // of the grid
  double noise_;        // of the points
  bool clean_ = false;  // the noise is no matter
  Grid grid_;
  VecX values_;                   // of the tori at its nodes
  MatX3i faces_;                  // of their zero set, as far as it is measured to
  VecX at_corners_, at_centres_;  // of these: values of the tori
  std::unique_ptr<TriangleBvh> bvh_;
  LevelPatch patch_;
};

/// How far points are off a smooth surface through their neighbours: the median, over the points,
/// of |(n_i + n_j) / 2 . (x_j - x_i)| for the six nearest, times 1.05. Around a smooth surface
/// that vanishes to third order, and for independent errors of deviation s, along the normal, it
/// is s.
double cloud_noise(const MatX3& points, const MatX3& normals, const PointTree& tree);

}  // namespace littoral
