#include "api/space/input_queries.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "api/space/space_input.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "spatial/morton_order.h"
#include "spatial/smoothed_winding.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

/// visit(i) for all queries on all threads, neighbours in space after one another.
template <class Visit>
void visit_queries(const MatX3& queries, const Task& task, const Visit& visit) {
  const std::vector<int> order = morton_order(queries);
  visit_in_order(order, order.size(), task, visit);
}

}  // namespace

NearestOnInput::NearestOnInput(const PolygonSoup& input) {
  bounding_box(input);  // complains
  if (input.n_faces() == 0) {
    points_ = input.points;
    cloud_ = std::make_unique<const PointTree>(points_);
    return;
  }
  // Face by face, so that each triangle knows its own.
  std::vector<int> corners;
  for (int f = 0; f < input.n_faces(); ++f) {
    PolygonSoup face;
    const auto cycle = input.face(f);
    if (cycle.size() == 3) {
      corners.insert(corners.end(), cycle.begin(), cycle.end());
      face_of_.push_back(f);
      continue;
    }
    face.points.resize(index(cycle.size()), 3);
    std::vector<int> local(cycle.size());
    for (std::size_t k = 0; k < cycle.size(); ++k) {
      face.points.row(index(k)) = input.points.row(cycle[k]);
      local[k] = static_cast<int>(k);
    }
    face.add_face(local);
    for (const int k : triangulate(face).corners) {
      if (corners.size() == 3 * face_of_.size()) face_of_.push_back(f);
      corners.push_back(cycle[k]);
    }
  }
  corners_ = Eigen::Map<const MatX3i>(corners.data(), index(face_of_.size()), 3);
  triangles_ = std::make_unique<const TriangleBvh>(input.points, corners_);
}

NearestPoints NearestOnInput::at(const MatX3& queries, const Task& task) const {
  const Eigen::Index n = queries.rows();
  NearestPoints out{MatX3(n, 3), VecXi(n), MatX3i(n, 3), MatX3(n, 3), VecX(n)};
  visit_queries(queries, task, [&](int i) {
    const Vec3 x = queries.row(i);
    if (cloud_) {
      const int p = cloud_->nearest(x).point;
      out.points.row(i) = points_.row(p);
      out.elements[i] = p;
      out.corners.row(i).setConstant(p);
      out.barycentric.row(i) << 1, 0, 0;
      out.distances[i] = (points_.row(p).transpose() - x).norm();
      return;
    }
    const NearestPoint nearest = triangles_->closest_point(x);
    out.points.row(i) = nearest.point;
    out.elements[i] = face_of_[nearest.face];
    out.corners.row(i) = corners_.row(nearest.face);
    for (int k = 0; k < 3; ++k) out.barycentric(i, k) = nearest.barycentric[k];
    out.distances[i] = nearest.distance;
  });
  return out;
}

VecX smoothed_winding(const PolygonSoup& input, const Orientation& orientation, double sigma,
                      const MatX3& queries, Task task, Report& report) {
  const Frame frame(bounding_box(input));
  const double deviation = sigma / frame.unit;
  if (!(deviation > 0 && std::isfinite(deviation)))
    throw InputError("option smoothing must be positive and finite, not " + number_text(sigma),
                     "option-value");
  // Sides of half a deviation: about so many samples.
  double area = 0;
  const MatX3i triangles = triangles_of(triangulate(input));
  const MatX3 points = frame.local(input.points);
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const auto corner = [&](int k) { return Vec3(points.row(triangles(f, k))); };
    area += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  if (!(area / (deviation * deviation) < (1 << 20)))
    throw InputError("option smoothing: " + rounded_text(sigma) +
                         " is too small for a surface of this size; without it winding numbers are "
                         "exact",
                     "option-value");
  const OrientedPoints s = make_input({input, orientation.flip, orientation.estimate_normals},
                                      frame, deviation / 2, task, report)
                               .samples;
  report.sizes.emplace_back("samples", static_cast<double>(s.size()));
  const SmoothedWindingNumber winding(s.points, s.normals, s.areas, deviation);
  const Stopwatch watch(report, "evaluate");
  const MatX3 local = frame.local(queries);
  VecX values(queries.rows());
  visit_queries(local, task.stage(0.9, "winding number"),
                [&](int i) { values[i] = winding(local.row(i)); });
  return values;
}

WindingOfInput::WindingOfInput(const PolygonSoup& input, const Orientation& orientation, Task task,
                               Report& report)
    : frame_(bounding_box(input)), flipped_(orientation.flip) {
  const SpaceInput local = make_input({input, orientation.flip, orientation.estimate_normals},
                                      frame_, infinity, task, report);
  const OrientedPoints& s = local.samples;
  constexpr auto together = WindingNumber::Queries::together;
  if (local.is_cloud()) {
    winding_ = std::make_unique<const WindingNumber>(s.points, s.normals, s.areas, together);
    return;
  }
  points_ = local.surface.points;
  triangles_ = local.triangles();
  winding_ = std::make_unique<const WindingNumber>(points_, triangles_, together);
}

VecX WindingOfInput::at(const MatX3& queries, const Task& task) const {
  return winding_->at(frame_.local(queries), task);
}

VecX WindingOfInput::confidence(const MatX3& queries, const Task& task) const {
  const auto settled = [&]() -> std::shared_ptr<const SettledSides> {
    if (triangles_.rows() == 0) return {};  // a cloud has nothing but its normals
    return sides_.get([&] {
      Report ignored;  // the distance's holds the same
      return settled_sides(points_, triangles_, flipped_, task, ignored);
    });
  }();
  const MatX3 local = frame_.local(queries);
  VecX values(queries.rows());
  visit_queries(local, task, [&](int i) {
    const Vec3 x = local.row(i);
    const double inside = settled ? settled->inside(x, 3) : SideRule{}.inside((*winding_)(x));
    values[i] = std::min(1.0, 2 * std::abs(inside));
  });
  return values;
}

}  // namespace littoral
