#include "domain/cloud/cloud_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "base/parallel.h"
#include "domain/cloud/cloud_normals.h"
#include "domain/intrinsic/tufted_cover.h"
#include "littoral/error.h"
#include "spatial/point_tree.h"

namespace littoral {

namespace {

constexpr int n_neighbours = 30;

/// Nearest other points of each point, those at the same place left out; ascending.
std::vector<std::vector<Neighbour>> find_neighbours(const MatX3& points) {
  std::vector<int> finite;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) finite.push_back(i);
  if (finite.empty()) throw InputError("the point cloud has no finite point", "empty-input");
  MatX3 kept(finite.size(), 3);
  for (std::size_t i = 0; i < finite.size(); ++i) kept.row(i) = points.row(finite[i]);
  const PointTree tree(kept);
  std::vector<std::vector<Neighbour>> out(points.rows());
  parallel_for(kept.rows(), 256, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, n_neighbours + 1> found;
    for (std::size_t i = begin; i < end; ++i) {
      const int n = tree.nearest(kept.row(i), n_neighbours + 1, found.data());
      for (int k = 0; k < n; ++k)
        if (found[k].squared_distance > 0)
          out[finite[i]].push_back({found[k].squared_distance, finite[found[k].point]});
    }
  });
  return out;
}

using Neighbours = std::vector<std::vector<Neighbour>>;

/// Normals of the points that are finite; 0 for others.
MatX3 finite_normals(const MatX3& points, const Task& task) {
  std::vector<Eigen::Index> finite;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) finite.push_back(i);
  MatX3 normals = MatX3::Zero(points.rows(), 3);
  normals(finite, Eigen::all) = estimate_normals(points(finite, Eigen::all), task);
  return normals;
}

/// Neighbours of the origin in the Delaunay triangulation of the origin and points q, in circular
/// order, as consecutive pairs: edges of the convex hull of the origin and the inverted points that
/// do not touch the origin. Pairs whose circumcircle is wider than `reach` are left out.
std::vector<std::array<int, 2>> delaunay_star(const std::vector<Complex>& q, double reach) {
  struct Point {
    double x, y;
    int id;
  };
  std::vector<Point> p{{0, 0, -1}};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const double s = std::norm(q[i]);
    if (s > 0) p.push_back({q[i].real() / s, q[i].imag() / s, static_cast<int>(i)});
  }
  std::sort(p.begin(), p.end(), [](const Point& a, const Point& b) {
    return std::tie(a.x, a.y, a.id) < std::tie(b.x, b.y, b.id);
  });
  auto turn = [](const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const Point& next : p) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), next) <= 0)
        hull.pop_back();
      hull.push_back(next);
    }
    hull.pop_back();  // begins the other chain
    std::reverse(p.begin(), p.end());
  }
  std::vector<std::array<int, 2>> star;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const int a = hull[i].id, b = hull[(i + 1) % hull.size()].id;
    if (a < 0 || b < 0 || a == b) continue;
    const double area2 = std::abs((std::conj(q[a]) * q[b]).imag());
    const double diameter = std::abs(q[a]) * std::abs(q[b]) * std::abs(q[a] - q[b]) / area2;
    if (area2 > 0 && diameter <= reach) star.push_back({a, b});
  }
  return star;
}

/// Triangles by sorted corners, with the number of corners that made them.
std::map<std::array<int, 3>, int> local_triangles(const MatX3& points, const MatX3& normals,
                                                  const Neighbours& neighbours) {
  std::vector<std::vector<std::array<int, 2>>> stars(neighbours.size());
  parallel_for(points.rows(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Index row = i;
      const Vec3 n = normals.row(row), x = tangent_axis(n), y = n.cross(x);
      std::vector<Complex> q;
      std::vector<int> id;
      for (const Neighbour& near : neighbours[i]) {
        if (normals.row(near.point).dot(normals.row(row)) <= 0) continue;  // another sheet
        const Vec3 d = points.row(near.point) - points.row(row);
        Complex z(x.dot(d), y.dot(d));
        if (std::abs(z) < 0.1 * d.norm()) continue;  // above, not beside
        q.push_back(z * (d.norm() / std::abs(z)));
        id.push_back(near.point);
      }
      if (neighbours[i].empty()) continue;
      const double reach = std::sqrt(neighbours[i].back().squared_distance);
      for (const auto& [a, b] : delaunay_star(q, reach)) stars[i].push_back({id[a], id[b]});
    }
  });
  std::map<std::array<int, 3>, int> count;
  for (std::size_t i = 0; i < stars.size(); ++i)
    for (const auto& [a, b] : stars[i]) {
      std::array<int, 3> corners{static_cast<int>(i), a, b};
      std::sort(corners.begin(), corners.end());
      ++count[corners];
    }
  return count;
}

struct LocalTriangles {
  PolygonSoup soup;         // the cloud with its triangles, counter-clockwise about the normals
  std::vector<int> counts;  // triangles; corners that made each
  MatX3 normals{0, 3};      // unit
};

LocalTriangles triangulated(const PolygonSoup& cloud, Report& report, const Task& task) {
  LocalTriangles out{cloud, {}, cloud.normals};
  const MatX3& points = cloud.points;
  const Neighbours neighbours = find_neighbours(points);
  if (cloud.normals.rows() != points.rows()) {
    out.normals = finite_normals(points, task);
    report.warn(
        "normals-estimated",
        "the point cloud has no normals; they were estimated, upward at the top of each part");
  }
  for (auto n : out.normals.rowwise()) n = normalized_or_z(n.transpose()).transpose();
  for (const auto& [corners, count] : local_triangles(points, out.normals, neighbours)) {
    std::array<int, 3> c = corners;
    Vec3 normal = Vec3::Zero();
    for (int v : c) normal += out.normals.row(v).transpose();
    const Vec3 a = points.row(c[0]), b = points.row(c[1]), d = points.row(c[2]);
    if ((b - a).cross(d - a).dot(normal) < 0) std::swap(c[1], c[2]);
    out.soup.add_face(c);
    out.counts.push_back(count);
  }
  return out;
}

/// A triangle of a cover, whichever way it was listed: cells that agree are made one.
struct Cell {
  std::array<int, 3> v;          // counter-clockwise seen from outside, the smallest first
  std::array<double, 3> length;  // of side k, from corner k to k + 1
  auto operator<=>(const Cell&) const = default;
};

Cell cell_of(const TuftedCover::Face& f, const NodalSurface& S) {
  Cell c{f.v, f.length};
  const SurfaceMesh& mesh = *S.refined;
  Vec3 normal = Vec3::Zero();
  for (int v : c.v) normal += S.normals.row(v).transpose();
  const Vec3 a = mesh.point(c.v[0]) / S.place->unit;
  const Vec3 b = mesh.point(c.v[1]) / S.place->unit - a, d = mesh.point(c.v[2]) / S.place->unit - a;
  if (b.cross(d).dot(normal) < 0) {
    std::swap(c.v[1], c.v[2]);
    std::swap(c.length[0], c.length[2]);
  }
  const auto first = std::min_element(c.v.begin(), c.v.end()) - c.v.begin();
  std::rotate(c.v.begin(), c.v.begin() + first, c.v.end());
  std::rotate(c.length.begin(), c.length.begin() + first, c.length.end());
  return c;
}

/// Cells, patches and weights: the intrinsic Delaunay triangulations of three tufted covers, each
/// side of each of which counts a sixth. Cover m is that of the triangles that at least m of their
/// corners made; where the corners agree all three are the same.
void add_cells(NodalSurface& S, const std::vector<int>& counts, Report& report, const Task& task) {
  const IntrinsicTriangulation& place = *S.place;
  const MatX3 points = S.refined->points() / place.unit;
  std::map<Cell, double> cells;
  long long flips = 0;
  for (int m = 1; m <= 3; ++m) {
    std::vector<int> kept;
    for (int t = 0; t < place.n_faces(); ++t)
      if (counts[t] >= m) kept.push_back(t);
    TuftedCover cover(points, place.faces.matrix()(kept, Eigen::all));
    flips += cover.flip_to_delaunay(task);
    for (const TuftedCover::Face& f : cover.faces()) cells[cell_of(f, S)] += 1.0 / 6;
  }
  report.sizes.emplace_back("intrinsic_flips", static_cast<double>(flips));

  auto T = std::make_shared<IntrinsicTriangulation>();
  T->unit = place.unit;
  T->n_vertices = place.n_vertices;
  T->component = place.component;
  T->n_components = place.n_components;
  T->mean_edge_length = place.mean_edge_length;
  const Eigen::Index n = cells.size();
  MatX3i corners(n, 3);
  T->length.resize(n, 3);
  T->orientation.assign(cells.size(), 1);
  S.weight.resize(n);
  S.patch_normals.resize(n, 3);
  int t = 0;
  for (const auto& [cell, weight] : cells) {
    Vec3 normal = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      corners(t, k) = cell.v[k];
      T->length(t, k) = cell.length[k];
      normal += S.normals.row(cell.v[k]).transpose();
    }
    S.weight[t] = weight;
    S.patch_normals.row(t) = normalized_or_z(normal);
    S.patch_offsets.push_back(t++);
  }
  S.patch_offsets.push_back(t);
  T->faces = SharedRows<int, 3>(std::move(corners));
  S.cells = T;
}

}  // namespace

PolygonSoup cloud_triangles(const PolygonSoup& cloud, Report& report, const Task& task) {
  return triangulated(cloud, report, task).soup;
}

NodalSurface cloud_surface(const MatX3& points, const MatX3& normals, Report& report,
                           const Task& task) {
  PolygonSoup cloud;
  cloud.points = points;
  cloud.normals = normals;
  LocalTriangles local = triangulated(cloud, report, task);
  if (local.counts.empty())
    throw InputError(
        "no triangle can be made between neighbouring points of the cloud: they lie on a line");
  NodalSurface S;
  S.domain = "point cloud";
  S.normals = std::move(local.normals);
  S.refined = std::make_shared<const SurfaceMesh>(std::move(local.soup));
  Report inner;  // its warnings are about meshes
  auto place = std::make_shared<IntrinsicTriangulation>(intrinsic_triangulation(*S.refined, inner));
  // All triangles are counter-clockwise about the normals, also where they overlap.
  place->orientation.assign(place->orientation.size(), 1);
  place->seams.resize(0, 3);
  double sum = 0;
  for (int e = 0; e < place->n_edges(); ++e)
    sum += (points.row(place->edges(e, 0)) / place->unit -
            points.row(place->edges(e, 1)) / place->unit)
               .norm();
  S.spacing = sum / place->n_edges();
  S.place = place;
  S.P.resize(points.rows(), points.rows());
  S.P.setIdentity();
  add_cells(S, local.counts, report, task);
  return S;
}

}  // namespace littoral
