#include "methods/implicit/completed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "methods/implicit/grid_signs.h"

namespace littoral {

namespace {

// Distances from which clusters are expanded, in their radii. Where the winding number is an
// integer errors of .003 do not matter; patches lie where it is not.
constexpr double accuracy_closed = 2.3, accuracy_open = 3;
constexpr double jumps_allowed = 0.01;
constexpr double off_surface = 1e-6;

double area_of(const MatX3& points, const MatX3i& faces) {
  double sum = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
               c = points.row(faces(f, 2));
    sum += (b - a).cross(c - a).norm() / 2;
  }
  return sum;
}

}  // namespace

CompletedSurface::CompletedSurface(const MatX3& points, const MatX3i& faces, double spacing,
                                   bool as_given, const Task& task, Report& report)
    : sides_(settled_sides(points, faces, as_given, task, report)),
      closed_(sides_.boundary.empty()) {
  task.checkpoint(0.3);
  report.sizes.emplace_back("free edges", static_cast<double>(sides_.boundary.size()));
  if (!closed_) {
    const Stopwatch watch(report, "patches");
    if (sides_.bounds)  // what bounds nothing has no holes to fill
      patch_ = level_patch([&](const Vec3& x) { return sides_.inside(x, accuracy_open); }, points,
                           sides_.boundary, spacing, task);
    report.sizes.emplace_back("patch triangles", static_cast<double>(patch_.faces.rows()));
    report.sizes.emplace_back("completed share of the zero set",
                              patch_.area / (patch_.area + area_of(points, sides_.faces)));
    if (patch_.finest > 0.6 * spacing)
      report.warn(
          "free-edges",
          "the input's faces have so many free edges that patches end a spacing before them; "
          "distances are less exact there. Weld vertices that belong together (option weld)");
  }
  task.checkpoint(0.8);
  MatX3 all(points.rows() + patch_.points.rows(), 3);
  all << points, patch_.points;
  MatX3i both(faces.rows() + patch_.faces.rows(), 3);
  both << faces, patch_.faces.array() + static_cast<int>(points.rows());
  bvh_ = std::make_unique<TriangleBvh>(all, both);
  normals_.resize(both.rows(), 3);
  for (Eigen::Index f = 0; f < both.rows(); ++f) {
    const Vec3 a = all.row(both(f, 0)), b = all.row(both(f, 1)), c = all.row(both(f, 2));
    normals_.row(f) = (b - a).cross(c - a).stableNormalized();
  }
}

bool CompletedSurface::is_inside(const Vec3& x) const {
  return sides_.inside(x, closed_ ? accuracy_closed : accuracy_open) > 0;
}

DistanceSample CompletedSurface::at(const Vec3& x) const {
  const NearestPoint foot = bvh_->closest_point(x);
  const double sign = is_inside(x) ? -1 : 1;
  DistanceSample out;
  out.value = sign * foot.distance;
  out.gradient = sign * (x - foot.point).stableNormalized();
  if (foot.distance > 0) return out;
  const Vec3 normal = normals_.row(foot.face);
  out.gradient = is_inside(x + off_surface * normal) ? -normal : normal;
  return out;
}

double CompletedSurface::value_after(const Vec3& x, int& last) const {
  const NearestPoint foot = bvh_->closest_point(x, last);
  last = foot.face;
  return is_inside(x) ? -foot.distance : foot.distance;
}

VecX CompletedSurface::on_grid(const Grid& grid, const Task& task) const {
  Task stages = task;
  VecX values = bvh_->distances(grid, stages.stage(0.9, "distance"));
  // The ball up to the nearest point is on one side of the surface and its patches, which end up to
  // a cell before the surface.
  const double reach = (closed_ ? 1 + 1e-9 : 1.5) * grid.spacing[0] + 1.5 * patch_.finest;
  set_signs(
      grid, reach, [&](const Vec3& x) { return is_inside(x); }, stages.stage(0.1, "sign"), values);
  return values;
}

VecX CompletedSurface::at_nodes(const Grid& grid, const Task& task, Report& report) const {
  VecX values = on_grid(grid, task);
  if (closed_) return values;
  // A surface between two nodes is no farther from them than they are from each other.
  std::size_t changes = 0, jumps = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const std::array<int, 3> at{i, j, k};
        const double here = values[index(grid.node(i, j, k))];
        for (int a = 0; a < 3; ++a) {
          if (at[a] + 1 == grid.n[a]) continue;
          const double there = values[index(grid.node(i + (a == 0), j + (a == 1), k + (a == 2)))];
          if ((here < 0) == (there < 0)) continue;
          ++changes;
          jumps += std::abs(here) + std::abs(there) > 1.25 * grid.spacing[a];
        }
      }
  const double share = changes == 0 ? 0 : static_cast<double>(jumps) / static_cast<double>(changes);
  report.sizes.emplace_back("share of sign changes without surface", share);
  if (share > jumps_allowed) {
    report.status = "uncertain";
    report.warn(
        "sign-uncertain",
        "at " + percent_text(share) +
            " of the places where the sign changes there is neither input nor patch: signs are "
            "uncertain there, as around faces that are reversed or missing");
  }
  return values;
}

}  // namespace littoral
