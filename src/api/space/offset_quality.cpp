#include "api/space/offset_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "littoral/options.h"
#include "spatial/boundary_edges.h"
#include "spatial/morton_order.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr double median_allowed = 0.02;                          // of what was asked for
constexpr double far_off = 0.1, far_off_share = 0.1;             // of it, of the area
constexpr double greatest_allowed = 1.15, least_allowed = 0.85;  // at any vertex

/// A third of the triangles around each vertex.
VecX vertex_areas(const MatX3& points, const MatX3i& faces) {
  VecX areas = VecX::Zero(points.rows());
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
               c = points.row(faces(f, 2));
    const double area = (b - a).cross(c - a).norm() / 6;
    for (int k = 0; k < 3; ++k) areas[faces(f, k)] += area;
  }
  return areas;
}

/// Vertices of the least, the median (by area) and the greatest distance among some, -1 where these
/// are none, and their area.
struct DistanceSpread {
  int least = -1, median = -1, greatest = -1;
  double area = 0;
};

template <class Among>
DistanceSpread spread_among(const VecX& distance, const VecX& areas, const Among& among) {
  std::vector<int> sorted;
  DistanceSpread found;
  for (int v = 0; v < distance.size(); ++v) {
    if (!among(v)) continue;
    sorted.push_back(v);
    found.area += areas[v];
  }
  if (sorted.empty()) return found;
  std::sort(sorted.begin(), sorted.end(), [&](int a, int b) {
    return distance[a] < distance[b] || (distance[a] == distance[b] && a < b);
  });
  found.least = found.median = sorted.front();
  found.greatest = sorted.back();
  double below = 0;
  for (const int v : sorted) {
    if (below < found.area / 2) found.median = v;
    below += areas[v];
  }
  return found;
}

}  // namespace

void measure_offset(const Isosurface& offset, const PolygonSoup& input,
                    const PolygonSoup& completion, Report& report, const Task& task) {
  const PolygonSoup& surface = offset.surface;
  if (surface.n_faces() == 0) return;
  const JoinedTriangles target = join_triangles(input, completion);
  const TriangleBvh bvh(target.points, target.triangles);
  task.checkpoint();

  const auto n = surface.points.rows();
  VecX distance(n);
  std::vector<char> over_hole(n);
  const std::vector<int> order = morton_order(surface.points);
  parallel_for(n, 1024, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(static_cast<double>(begin) / static_cast<double>(n));
    int near = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const NearestPoint foot = bvh.closest_point(surface.points.row(order[i]), near);
      near = foot.face;
      distance[order[i]] = foot.distance;
      over_hole[order[i]] = foot.face >= target.n_first;
    }
  });

  const MatX3i faces = triangles_of(surface);
  const VecX areas = vertex_areas(surface.points, faces);
  const double total = areas.sum(), asked = std::abs(offset.level);
  const std::string name = "offset " + rounded_text(offset.level) + ": ";
  const DistanceSpread all = spread_among(distance, areas, [](int) { return true; });
  const DistanceSpread holes =
      spread_among(distance, areas, [&](int v) { return over_hole[v] != 0; });
  const DistanceSpread rest =
      spread_among(distance, areas, [&](int v) { return over_hole[v] == 0; });
  const auto edges = boundary_edges(surface.points, faces).size();
  report.sizes.emplace_back(name + "least distance", distance[all.least]);
  report.sizes.emplace_back(name + "median distance", distance[all.median]);
  report.sizes.emplace_back(name + "greatest distance", distance[all.greatest]);
  report.sizes.emplace_back(name + "share over holes", total > 0 ? holes.area / total : 0);
  report.sizes.emplace_back(name + "open edges", static_cast<double>(edges));
  if (edges > 0) report.status = "uncertain";  // the contour has warned
  if (asked == 0 || !(total > 0)) return;
  for (const auto& [part, where] : {std::pair(&rest, ""), {&holes, "over holes, "}}) {
    if (part->least < 0) continue;
    report.sizes.emplace_back(name + where + "least over asked", distance[part->least] / asked);
    report.sizes.emplace_back(name + where + "median over asked", distance[part->median] / asked);
    report.sizes.emplace_back(name + where + "greatest over asked",
                              distance[part->greatest] / asked);
  }

  const std::string remedy =
      "; raise option resolution" +
      (report.method == SpaceAutomatic::method
           ? ""
           : std::string(", and method ") + SpaceAutomatic::method + " for exact distances");
  double off = 0;
  for (Eigen::Index v = 0; v < n; ++v)
    if (std::abs(distance[v] - asked) > far_off * asked) off += areas[v];
  const double median = distance[all.median];
  if (std::abs(median - asked) > median_allowed * asked || off > far_off_share * total) {
    report.status = "uncertain";
    report.warn("accuracy-missed", name + "half of the surface is nearer than " +
                                       rounded_text(median) + ", and " +
                                       rounded_text(100 * off / total) +
                                       " % of it is more than a tenth off what was asked" + remedy);
  }
  const auto warn_at = [&](int v, const char* what) {
    const Vec3 x = surface.points.row(v);
    report.status = "uncertain";
    report.warn("accuracy-missed", name + "the surface is " + rounded_text(distance[v] / asked) +
                                       " times as " + what + " as asked at (" + rounded_text(x[0]) +
                                       ", " + rounded_text(x[1]) + ", " + rounded_text(x[2]) + ")" +
                                       (over_hole[v] != 0 ? ", over a hole of the input" : "") +
                                       remedy);
  };
  if (distance[all.greatest] > greatest_allowed * asked) warn_at(all.greatest, "far");
  if (distance[all.least] < least_allowed * asked) warn_at(all.least, "near");
}

}  // namespace littoral
