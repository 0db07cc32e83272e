// Point clouds as oriented samples, with areas from neighbours.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/groups.h"
#include "base/index.h"
#include "base/parallel.h"
#include "domain/cloud/cloud_normals.h"
#include "littoral/error.h"
#include "sources/space/oriented_points.h"
#include "spatial/places.h"
#include "spatial/point_tree.h"

namespace littoral {

namespace {

constexpr int neighbours = 16;  // enough for the Voronoi cell, the place itself among them

using Cell = std::vector<Vec2>;

/// The part of a polygon nearer to the origin than to q.
void clip_to_nearer(Cell& polygon, const Vec2& q) {
  Cell kept;
  const double limit = q.squaredNorm() / 2;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = a.dot(q) - limit, db = b.dot(q) - limit;
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.emplace_back(a + (b - a) * (da / (da - db)));
  }
  polygon = std::move(kept);
}

double polygon_area(const Cell& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// Area of the cell of place i in the plane with this normal, shared among the points there. Cells
/// are cut off at a disc, for there is nothing that bounds them at the rim of a surface.
double cell_area(const MatX3& places, const Groups<int>& points, const PointTree& tree, int i,
                 const Vec3& normal) {
  const Vec3 p = places.row(i);
  const Vec3 e1 = normal.unitOrthogonal(), e2 = normal.cross(e1);
  for (int k = neighbours;; k *= 4) {
    std::vector<Neighbour> near(k);
    const int n = tree.nearest(p, k, near.data());
    const double reach = std::sqrt(near[n - 1].squared_distance);
    int same = 0;  // places that round-off does not tell apart, itself among them
    std::size_t sharing = 0;
    while (same < n && near[same].squared_distance <= 1e-20 * reach * reach)
      sharing += points.at(near[same++].point).size();
    if (n - same < std::min(6, tree.size() - same) && n < tree.size()) continue;
    if (same == n) return 0;
    const int rim = same + (std::min(n - same, 6) + 1) / 2 - 1;
    const double radius = std::sqrt(near[rim].squared_distance);
    Cell cell;
    for (int c = 0; c < 12; ++c) {
      const double angle = 2 * M_PI * c / 12;
      cell.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    for (int j = same; j < n; ++j) {
      const Vec3 d = places.row(near[j].point).transpose() - p;
      const Vec2 q(d.dot(e1), d.dot(e2));
      if (q.squaredNorm() > 1e-6 * d.squaredNorm()) clip_to_nearer(cell, q);
    }
    return polygon_area(cell) / static_cast<double>(sharing);
  }
}

}  // namespace

OrientedPoints sample_cloud(const PolygonSoup& cloud, Report& report) {
  if (cloud.points.rows() == 0) throw InputError("the point cloud has no points", "empty-input");
  if (cloud.normals.rows() != cloud.points.rows())
    throw InputError("the point cloud has no normals; option estimate-normals computes some",
                     "no-normals");
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const Vec3 n = cloud.normals.row(i);
    if (n.allFinite() && n.stableNorm() > 0) kept.push_back(i);
  }
  if (kept.empty())
    throw InputError(
        "no point has a normal that is not zero; option estimate-normals computes some",
        "no-normals");
  if (index(kept.size()) < cloud.points.rows())
    report.warn("normals-unusable", counted(cloud.points.rows() - index(kept.size()),
                                            "point without a finite normal other than zero was",
                                            "points without finite normals other than zero were") +
                                        " left out");
  OrientedPoints out;
  out.points = cloud.points(kept, Eigen::all);
  out.normals = cloud.normals(kept, Eigen::all);
  for (auto n : out.normals.rowwise()) n.stableNormalize();
  check_cloud(out.points);
  out.areas.resize(out.size());
  const Groups<int> points = points_by_place(out.points);
  MatX3 places(index(points.begin.size()) - 1, 3);
  for (int i = 0; i < places.rows(); ++i) places.row(i) = out.points.row(points.at(i).front());
  const PointTree tree(places);
  parallel_for(std::size_t(places.rows()), 1024, [&](std::size_t begin, std::size_t end) {
    for (int i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      for (const int point : points.at(i))
        out.areas[point] = cell_area(places, points, tree, i, out.normals.row(point));
  });
  // Cells of collinear points may be empty; nothing may weigh nothing.
  const double floor = 1e-6 * out.areas.mean();
  if (!(floor > 0))
    throw InputError(
        "the points of the cloud span no area: they are at one place, or nearer to each other than "
        "double precision resolves");
  out.areas = out.areas.cwiseMax(floor);
  return out;
}

}  // namespace littoral
