// Point clouds as oriented samples, with areas from neighbours.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "domain/cloud/cloud_normals.h"
#include "littoral/error.h"
#include "sources/space/oriented_points.h"
#include "spatial/point_tree.h"

namespace littoral {

namespace {

constexpr int enough = 15;  // neighbours, for the Voronoi cell

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

/// Area of the cell of point i in its tangent plane, shared among the points at its place. Cells
/// are cut off at a disc, for there is nothing that bounds them at the rim of a surface.
double cell_area(const MatX3& points, const PointTree& tree, Eigen::Index i, const Vec3& normal) {
  const Vec3 p = points.row(i);
  const Vec3 e1 = normal.unitOrthogonal(), e2 = normal.cross(e1);
  for (int k = 1 + enough;; k *= 4) {
    std::vector<Neighbour> near(k);
    const int n = tree.nearest(p, k, near.data());
    const double reach = std::sqrt(near[n - 1].squared_distance), one_place = 1e-20 * reach * reach;
    int same = 0;  // points at this place, itself among them
    while (same < n && near[same].squared_distance <= one_place) ++same;
    std::vector<Neighbour> others;  // one for each of the nearest other places
    for (int j = same; j < n && int_size(others) < enough; ++j)
      if (std::none_of(others.begin(), others.end(), [&](const Neighbour& other) {
            return (points.row(near[j].point) - points.row(other.point)).squaredNorm() <= one_place;
          }))
        others.push_back(near[j]);
    if (int_size(others) < enough && n < tree.size()) continue;
    if (others.empty()) return 0;
    const int rim = (std::min(int_size(others), 6) + 1) / 2 - 1;
    const double radius = std::sqrt(others[rim].squared_distance);
    Cell cell;
    for (int c = 0; c < 12; ++c) {
      const double angle = 2 * M_PI * c / 12;
      cell.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    for (const Neighbour& other : others) {
      const Vec3 d = points.row(other.point).transpose() - p;
      const Vec2 q(d.dot(e1), d.dot(e2));
      if (q.squaredNorm() > 1e-6 * d.squaredNorm()) clip_to_nearer(cell, q);
    }
    return polygon_area(cell) / same;
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
  const PointTree tree(out.points);
  parallel_for(kept.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index i = begin; i < index(end); ++i)
      out.areas[i] = cell_area(out.points, tree, i, out.normals.row(i));
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
