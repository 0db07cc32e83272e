#include "methods/implicit/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "base/parallel.h"
#include "methods/implicit/grid_signs.h"
#include "spatial/point_tree.h"
#include "spatial/triangle_bvh.h"
#include "spatial/winding_number.h"

namespace littoral {

namespace {

constexpr double sign_accuracy = 2.3;  // errors of .003 do not matter to a comparison with 1/2

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

/// Of unit length, zero where a face has no area.
MatX3 face_normals(const MatX3& points, const MatX3i& faces) {
  MatX3 normals = MatX3::Zero(faces.rows(), 3);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
               c = points.row(faces(f, 2));
    const Vec3 n = (b - a).cross(c - a).stableNormalized();
    if (n.allFinite()) normals.row(f) = n;
  }
  return normals;
}

/// Angle-weighted normals at corners, and sums of normals across edges. Vertices at one position
/// count as one, so that soups whose faces share nothing but positions work as well.
class Pseudonormals {
 public:
  Pseudonormals(const MatX3& points, const MatX3i& faces, const MatX3& normals)
      : faces_(faces), normals_(normals) {
    std::map<std::array<double, 3>, int> place;
    for (Eigen::Index v = 0; v < points.rows(); ++v)
      vertex_.push_back(place.try_emplace({points(v, 0), points(v, 1), points(v, 2)}, place.size())
                            .first->second);
    at_vertex_ = MatX3::Zero(place.size(), 3);
    for (Eigen::Index f = 0; f < faces.rows(); ++f) {
      std::array<Vec3, 3> p;
      for (int k = 0; k < 3; ++k) p[k] = points.row(faces(f, k));
      const Vec3 n = normals.row(f);
      if (n.isZero(0)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
        const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
        at_vertex_.row(vertex(f, k)) += angle * n;
        const auto [edge, is_new] = at_edge_.try_emplace(edge_key(f, k), n);
        if (!is_new) edge->second += n;
      }
    }
  }

  /// Where the foot lies on a corner or side to within rounding, that one's normal.
  Vec3 at(const NearestPoint& foot) const {
    constexpr double rounding = 1e-10;
    int zeros = 0, zero = 0, one = 0;
    for (int k = 0; k < 3; ++k) {
      if (foot.barycentric[k] <= rounding) {
        ++zeros;
        zero = k;
      } else {
        one = k;
      }
    }
    if (zeros == 2) return at_vertex_.row(vertex(foot.face, one));
    if (zeros == 1) {
      const auto edge = at_edge_.find(edge_key(foot.face, (zero + 1) % 3));
      if (edge != at_edge_.end()) return edge->second;
    }
    return normals_.row(foot.face);
  }

 private:
  int vertex(Eigen::Index f, int k) const { return vertex_[faces_(f, k)]; }
  std::pair<int, int> edge_key(Eigen::Index f, int k) const {
    return std::minmax({vertex(f, k), vertex(f, (k + 1) % 3)});
  }

  MatX3i faces_;
  std::vector<int> vertex_;  // vertex -> position
  MatX3 normals_, at_vertex_;
  std::map<std::pair<int, int>, Vec3> at_edge_;
};

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
        pseudonormals_ = std::make_unique<Pseudonormals>(points, faces, normals_);
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
    if (!winding_) return PointwiseDistance::on_grid(grid, task);
    Task stages = task;
    VecX values = bvh_->distances(grid, stages.stage(0.7, "distance"));
    set_signs(
        grid, std::numeric_limits<double>::infinity(),
        [&](const Vec3& x) { return (*winding_)(x, sign_accuracy) > 0.5; },
        stages.stage(0.3, "sign"), values);
    return values;
  }

 private:
  bool is_inside(const Vec3& x, const NearestPoint& foot) const {
    return winding_ ? (*winding_)(x, sign_accuracy) > 0.5
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
    const bool inside = winding_ ? (*winding_)(x, sign_accuracy) > 0.5 : n.dot(x - p) < 0;
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
