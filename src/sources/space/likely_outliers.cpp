#include "sources/space/likely_outliers.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "spatial/point_tree.h"

namespace littoral {

namespace {

constexpr int asked = 12, needed = 4, passes = 4;
constexpr double steepest = 0.6;  // sine of the angle under which a neighbour may rise
constexpr double alike = 0.3;     // least cosine between normals

bool agree(const OrientedPoints& cloud, int i, int j, double distance) {
  const Vec3 d = (cloud.points.row(j) - cloud.points.row(i)).transpose() / distance;
  return std::abs(d.dot(cloud.normals.row(i))) < steepest &&
         std::abs(d.dot(cloud.normals.row(j))) < steepest &&
         cloud.normals.row(i).dot(cloud.normals.row(j)) > alike;
}

/// Rows of points that enough neighbours agree with.
std::vector<Eigen::Index> borne_out(const OrientedPoints& cloud, const Task& task) {
  const PointTree tree(cloud.points);
  const std::size_t n = cloud.size();
  std::vector<char> good(n, 0);
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    std::array<Neighbour, asked + 1> found;
    for (std::size_t i = begin; i < end; ++i) {
      const int point = i;
      const int count = tree.nearest(cloud.points.row(point), asked + 1, found.data());
      int votes = 0;
      for (int j = 1; j < count; ++j)
        votes += agree(cloud, point, found[j].point, std::sqrt(found[j].squared_distance));
      good[i] = votes >= needed;
    }
  });
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < n; ++i)
    if (good[i]) rows.push_back(i);
  return rows;
}

}  // namespace

OrientedPoints without_outliers(const OrientedPoints& cloud, const Task& task, Report& report) {
  OrientedPoints kept = cloud;
  for (int pass = 0; pass < passes; ++pass) {
    const std::vector<Eigen::Index> rows = borne_out(kept, task);
    if (index(rows.size()) == kept.size()) break;
    if (rows.size() < 2 * asked || index(rows.size()) < cloud.size() / 4) {
      report.warn("outliers",
                  "too few points agree with their neighbours: none was taken for an outlier");
      return cloud;
    }
    OrientedPoints next;
    next.points = kept.points(rows, Eigen::all);
    next.normals = kept.normals(rows, Eigen::all);
    if (kept.areas.size() > 0) next.areas = kept.areas(rows);
    kept = std::move(next);
  }
  if (kept.size() < cloud.size())
    report.warn("outliers", counted(cloud.size() - kept.size(), "point was taken for an outlier",
                                    "points were taken for outliers") +
                                " and left out");
  return kept;
}

}  // namespace littoral
