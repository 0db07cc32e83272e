#include "methods/implicit/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "methods/implicit/grid_signs.h"
#include "spatial/point_tree.h"
#include "spatial/pseudonormals.h"
#include "spatial/triangle_bvh.h"
#include "spatial/winding_number.h"

namespace littoral {

namespace {

/// Distance and gradient from the nearest point, its normal (for queries on the surface) and a
/// side.
DistanceSample signed_sample(const Vec3& x, const Vec3& nearest, double distance, bool inside,
                             const Vec3& normal) {
  const double sign = inside ? -1 : 1;
  DistanceSample out;
  out.value = sign * distance;
  out.gradient = distance > 0 ? Vec3(sign * (x - nearest).stableNormalized()) : normal;
  return out;
}

class ToTriangles : public PointwiseDistance {
 public:
  ToTriangles(const MatX3& points, const MatX3i& faces, SignRule rule)
      : normals_(face_normals(points, faces)) {
    parallel_for(2, 1, [&](std::size_t part, std::size_t) {
      if (part == 0)
        bvh_ = std::make_unique<TriangleBvh>(points, faces);
      else if (rule == SignRule::winding)
        winding_ = std::make_unique<WindingNumber>(points, faces);
      else
        pseudonormals_ = std::make_unique<Pseudonormals>(points, faces);
    });
  }
  DistanceSample at(const Vec3& x) const override {
    const NearestPoint foot = bvh_->closest_point(x);
    return signed_sample(x, foot.point, foot.distance, is_inside(x, foot), normals_.row(foot.face));
  }
  double value_after(const Vec3& x, int& last) const override {
    const NearestPoint foot = bvh_->closest_point(x, last);
    last = foot.face;
    return is_inside(x, foot) ? -foot.distance : foot.distance;
  }
  VecX on_grid(const Grid& grid, const Task& task) const override {
    if (!winding_)
      return bvh_->values_at_nodes(
          grid,
          [&](const Vec3& x, const NearestPoint& foot) {
            return is_inside(x, foot) ? -foot.distance : foot.distance;
          },
          task);
    Task stages = task;
    VecX values = bvh_->distances(grid, stages.stage(0.7, "distance"));
    set_signs(
        grid, infinity,
        [&](const Vec3& x) { return (*winding_)(x, WindingNumber::sign_accuracy) > 0.5; },
        stages.stage(0.3, "sign"), values);
    return values;
  }

 private:
  bool is_inside(const Vec3& x, const NearestPoint& foot) const {
    return winding_ ? (*winding_)(x, WindingNumber::sign_accuracy) > 0.5
                    : pseudonormals_->at(foot).dot(x - foot.point) < 0;
  }

  std::unique_ptr<TriangleBvh> bvh_;
  MatX3 normals_;                           // of the faces
  std::unique_ptr<WindingNumber> winding_;  // one of the two
  std::unique_ptr<Pseudonormals> pseudonormals_;
};

class ToPoints : public PointwiseDistance {
 public:
  ToPoints(OrientedPoints samples, SignRule rule)
      : samples_(std::move(samples)), tree_(samples_.points) {
    if (rule == SignRule::winding)
      winding_ = std::make_unique<WindingNumber>(samples_.points, samples_.normals, samples_.areas);
  }
  DistanceSample at(const Vec3& x) const override {
    const Neighbour found = tree_.nearest(x);
    const Vec3 p = samples_.points.row(found.point), n = samples_.normals.row(found.point);
    const bool inside =
        winding_ ? (*winding_)(x, WindingNumber::sign_accuracy) > 0.5 : n.dot(x - p) < 0;
    return signed_sample(x, p, std::sqrt(found.squared_distance), inside, n);
  }

 private:
  OrientedPoints samples_;
  PointTree tree_;
  std::unique_ptr<WindingNumber> winding_;
};

}  // namespace

std::unique_ptr<const PointwiseDistance> closest_point_distance(const MatX3& points,
                                                                const MatX3i& faces,
                                                                SignRule rule) {
  return std::make_unique<ToTriangles>(points, faces, rule);
}

std::unique_ptr<const PointwiseDistance> closest_point_distance(const OrientedPoints& samples,
                                                                SignRule rule) {
  return std::make_unique<ToPoints>(samples, rule);
}

}  // namespace littoral
