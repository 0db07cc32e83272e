#include "methods/implicit/completed_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "contour/isosurface.h"
#include "spatial/boundary_edges.h"
#include "spatial/grid_values.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

// Spacings from all points beyond which the zero set is completion, and beyond which the tori do
// not say how far it is: their values are never less than the nearest point's distance by more
// than a spacing.
constexpr double completing = 1.5, measuring = 0.75;
constexpr double clean_enough = 0.03;  // spacings of noise, below which tori measure better
constexpr double noise_margin = 4;     // deviations by which the nearest of many points is too near
constexpr double half = 0.5;           // of the grid's spacing: triangles are no farther off
constexpr double hardly = 0.01;        // of it
constexpr double much = 0.05;          // of the zero set's edges on the box

MatX3 normals_of_tori(const std::vector<Torus>& tori) {
  MatX3 normals(index(tori.size()), 3);
  for (std::size_t i = 0; i < tori.size(); ++i) normals.row(index(i)) = tori[i].n;
  return normals;
}

bool same(const Grid& a, const Grid& b) {
  return a.n == b.n && a.origin == b.origin && a.spacing == b.spacing;
}

}  // namespace

double cloud_noise(const MatX3& points, const MatX3& normals, const PointTree& tree) {
  constexpr int neighbours = 7;  // with the point itself
  constexpr double to_deviation = 1.05;
  const auto n = std::size_t(points.rows());
  std::vector<double> heights(n * neighbours, -1);
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, neighbours> found;
    for (std::size_t i = begin; i < end; ++i) {
      const int count = tree.nearest(points.row(index(i)), neighbours, found.data());
      for (int k = 0; k < count; ++k) {
        const int j = found[k].point;
        if (j == static_cast<int>(i)) continue;
        const Vec3 along = points.row(j) - points.row(index(i));
        const Vec3 mean = (normals.row(index(i)) + normals.row(j)) / 2;
        heights[i * neighbours + k] = std::abs(mean.dot(along));
      }
    }
  });
  std::erase(heights, -1.0);
  if (heights.empty()) return 0;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return to_deviation * *middle;
}

CompletedCloud::CompletedCloud(std::unique_ptr<const ToriDistance> tori, const Grid& grid,
                               const Task& task, Report& report)
    : tori_(std::move(tori)),
      points_(tori_->points()),
      spacing_(grid.spacing.maxCoeff()),
      noise_(cloud_noise(tori_->points(), normals_of_tori(tori_->tori()), points_)),
      grid_(grid) {
  const Stopwatch watch(report, "completing");
  Task stages = task;
  values_ = grid_values(grid, stages.stage(0.7, "zero set"),
                        [&](const Vec3& x, int& last) { return tori_->value_after(x, last); });
  Report unheard;  // open at the box: said below
  const PolygonSoup zero = isosurface(grid, values_, 0, {}, unheard, stages.stage(0.2, "zero set"));
  std::vector<double> spacings;
  for (const Torus& t : tori_->tori()) spacings.push_back(t.rho);
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  report.sizes.emplace_back("noise, in spacings of the points", noise_ / *middle);
  if (zero.n_faces() == 0) return;
  const MatX3i all = triangles_of(zero);
  patch_ = patch_beyond(completing, zero.points, all);
  report.sizes.emplace_back("completed share of the zero set",
                            patch_.area / patch_beyond(-1, zero.points, all).area);
  LevelPatch measured;
  clean_ = noise_ < clean_enough * *middle;
  if (clean_) measured = patch_beyond(measuring, zero.points, all);
  const MatX3& corners = clean_ ? measured.points : zero.points;
  faces_ = clean_ ? measured.faces : all;
  if (faces_.rows() > 0) {
    bvh_ = std::make_unique<TriangleBvh>(corners, faces_);
    measure_triangles(corners);
  }
  const auto open = boundary_edges(zero.points, all).size();
  report.sizes.emplace_back("open edges of the zero set", static_cast<double>(open));
  if (static_cast<double>(open) > much * std::sqrt(static_cast<double>(all.rows()))) {
    report.status = "uncertain";
    report.warn(
        "points-not-enclosing",
        "the points do not enclose what they bound: the surface through them goes on beyond them "
        "and ends where it was no longer looked for; signs are uncertain there");
  }
}

void CompletedCloud::measure_triangles(const MatX3& corners) {
  at_corners_.resize(corners.rows());
  parallel_for(std::size_t(corners.rows()), 256, [&](std::size_t b, std::size_t e) {
    for (auto v = index(b); v < index(e); ++v) at_corners_[v] = tori_->value(corners.row(v));
  });
  at_centres_.resize(faces_.rows());
  parallel_for(std::size_t(faces_.rows()), 256, [&](std::size_t b, std::size_t e) {
    for (auto f = index(b); f < index(e); ++f) {
      Vec3 centre = Vec3::Zero();
      for (int k = 0; k < 3; ++k) centre += corners.row(faces_(f, k)) / 3;
      at_centres_[f] = tori_->value(centre);
    }
  });
}

LevelPatch CompletedCloud::patch_beyond(double spacings, const MatX3& corners,
                                        const MatX3i& faces) const {
  LevelPatch patch;
  std::vector<int> far;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = corners.row(faces(f, 0)), b = corners.row(faces(f, 1)),
               c = corners.row(faces(f, 2));
    const Neighbour nearest = points_.nearest((a + b + c) / 3);
    const double rho = tori_->tori()[nearest.point].rho;
    if (!(nearest.squared_distance > spacings * spacings * rho * rho)) continue;
    far.push_back(static_cast<int>(f));
    patch.area += (b - a).cross(c - a).norm() / 2;
  }
  std::vector<int> number(std::size_t(corners.rows()), -1), used;
  patch.faces.resize(index(far.size()), 3);
  for (std::size_t i = 0; i < far.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int v = faces(far[i], k);
      if (number[v] < 0) {
        number[v] = static_cast<int>(used.size());
        used.push_back(v);
      }
      patch.faces(index(i), k) = number[v];
    }
  patch.points = corners(used, Eigen::all);
  patch.finest = spacing_;
  return patch;
}

CompletedCloud::Foot CompletedCloud::foot_of(const Vec3& x, double tori, int last) const {
  Foot foot;
  foot.tori = tori;
  if (!bvh_) return foot;
  const NearestPoint nearest = bvh_->closest_point(x, last);
  foot.face = nearest.face;
  foot.distance = nearest.distance;
  foot.point = nearest.point;
  // Linear between the corners, and a bubble that has the centre's value.
  double linear = 0, mean = 0, bubble = 27;
  for (int k = 0; k < 3; ++k) {
    const double at = at_corners_[faces_(nearest.face, k)];
    const double weight = nearest.barycentric[k];
    linear += weight * at;
    mean += at / 3;
    bubble *= weight;
  }
  const double off = linear + bubble * (at_centres_[nearest.face] - mean);
  if (std::abs(off) < half * spacing_) foot.off = off;  // otherwise the tori jump there
  const double measured = foot.distance + (tori < 0 ? -foot.off : foot.off);
  // Tori are no farther than the nearest point, which need not be looked for then. Noisy ones are
  // too near.
  const double margin = clean_ ? 0 : noise_margin * noise_ + hardly * spacing_;
  foot.by_tori = measured > std::abs(tori) + margin &&
                 (clean_ || measured > std::sqrt(points_.nearest(x).squared_distance) + margin);
  return foot;
}

double CompletedCloud::combined(const Foot& foot) const {
  if (foot.by_tori) return foot.tori;
  const double sign = foot.tori < 0 ? -1 : 1;
  double size = foot.distance + sign * foot.off;
  const double near = std::abs(foot.tori);
  if (foot.distance < spacing_ && std::abs(near - size) < half * spacing_) {
    const double w = foot.distance / spacing_;
    size = (1 - w) * near + w * size;
  }
  return sign * std::max(size, 0.0);
}

double CompletedCloud::value_after(const Vec3& x, int& last) const {
  const Foot foot = foot_of(x, tori_->value(x), last);
  last = foot.face;
  return combined(foot);
}

double CompletedCloud::value(const Vec3& x) const {
  int none = -1;
  return value_after(x, none);
}

DistanceSample CompletedCloud::at(const Vec3& x) const {
  const DistanceSample tori = tori_->at(x);
  const Foot foot = foot_of(x, tori.value, -1);
  DistanceSample out{combined(foot), tori.gradient};
  // Of smooth surfaces through points the tori have the better direction.
  if (!foot.by_tori && std::abs(std::abs(tori.value) - foot.distance) > half * spacing_)
    out.gradient = std::copysign(1.0, tori.value) * (x - foot.point).stableNormalized();
  return out;
}

VecX CompletedCloud::at_nodes(const Grid& grid, const Task& task, Report&) const {
  if (!same(grid, grid_)) return on_grid(grid, task);
  VecX values(values_.size());
  const std::size_t rows = std::size_t(grid.n[1]) * grid.n[2];
  parallel_for(rows, 1, [&](std::size_t row, std::size_t) {
    task.checkpoint(static_cast<double>(row) / static_cast<double>(rows));
    const int j = static_cast<int>(row % grid.n[1]), k = static_cast<int>(row / grid.n[1]);
    int last = -1;
    for (int i = 0; i < grid.n[0]; ++i) {
      const Eigen::Index node = index(grid.node(i, j, k));
      const Foot foot = foot_of(grid.point(i, j, k), values_[node], last);
      last = foot.face;
      values[node] = combined(foot);
    }
  });
  return values;
}

}  // namespace littoral
