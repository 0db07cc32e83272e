#include "littoral/domain/cloud_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <string>

#include "littoral/base/error.h"
#include "littoral/base/parallel.h"
#include "littoral/spatial/point_tree.h"

namespace littoral {

namespace {

constexpr int n_neighbours = 30;

/// Nearest other points of each point, those at the same place left out; ascending.
std::vector<std::vector<Neighbour>> find_neighbours(const MatX3& points) {
  std::vector<int> finite;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) finite.push_back(static_cast<int>(i));
  if (finite.empty()) throw InputError("the point cloud has no finite point");
  MatX3 kept(static_cast<Eigen::Index>(finite.size()), 3);
  for (std::size_t i = 0; i < finite.size(); ++i)
    kept.row(static_cast<Eigen::Index>(i)) = points.row(finite[i]);
  const PointTree tree(kept);
  std::vector<std::vector<Neighbour>> out(static_cast<std::size_t>(points.rows()));
  parallel_for(kept.rows(), 256, [&](std::size_t begin, std::size_t end) {
    std::array<Neighbour, n_neighbours + 1> found;
    for (std::size_t i = begin; i < end; ++i) {
      const int n =
          tree.nearest(kept.row(static_cast<Eigen::Index>(i)), n_neighbours + 1, found.data());
      for (int k = 0; k < n; ++k)
        if (found[k].squared_distance > 0)
          out[finite[i]].push_back({found[k].squared_distance, finite[found[k].point]});
    }
  });
  return out;
}

using Neighbours = std::vector<std::vector<Neighbour>>;

MatX3 estimated_normals(const MatX3& points, const Neighbours& neighbours) {
  const Eigen::Index n = points.rows();
  MatX3 normals = MatX3::Zero(n, 3);
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& around = neighbours[i];
      if (around.size() < 3) continue;
      const double scale = std::sqrt(around.back().squared_distance);
      Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
      Vec3 mean = Vec3::Zero();
      const std::size_t used = std::min<std::size_t>(around.size(), 12);
      for (std::size_t k = 0; k < used; ++k) {
        const Vec3 d =
            (points.row(around[k].point) - points.row(static_cast<Eigen::Index>(i))) / scale;
        mean += d / static_cast<double>(used + 1);
        C += d * d.transpose() / static_cast<double>(used + 1);
      }
      C -= mean * mean.transpose();
      normals.row(static_cast<Eigen::Index>(i)) =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(C).eigenvectors().col(0);
    }
  });

  // Orient: from the topmost point of each part outward, over the most parallel neighbours first.
  std::vector<int> order(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return points(a, 2) > points(b, 2);  // non-finite points have no neighbours: never asked
  });
  std::vector<char> done(static_cast<std::size_t>(n), 0);
  using Entry = std::tuple<double, int, int>;  // |cosine|, -to, from
  for (int seed : order) {
    if (done[seed] || neighbours[seed].empty()) continue;
    if (normals(seed, 2) < 0) normals.row(seed) *= -1;
    std::priority_queue<Entry> queue;
    queue.emplace(1, -seed, seed);
    while (!queue.empty()) {
      const auto [cosine, minus_to, from] = queue.top();
      queue.pop();
      const int to = -minus_to;
      if (done[to]) continue;
      done[to] = 1;
      if (normals.row(to).dot(normals.row(from)) < 0) normals.row(to) *= -1;
      for (std::size_t k = 0; k < std::min<std::size_t>(neighbours[to].size(), 12); ++k) {
        const int next = neighbours[to][k].point;
        if (!done[next]) queue.emplace(std::abs(normals.row(to).dot(normals.row(next))), -next, to);
      }
    }
  }
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
      const auto row = static_cast<Eigen::Index>(i);
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

}  // namespace

MatX3 estimate_normals(const MatX3& points) {
  return estimated_normals(points, find_neighbours(points));
}

NodalSurface cloud_surface(const MatX3& points, const MatX3& given, Report& report) {
  const Neighbours neighbours = find_neighbours(points);
  NodalSurface S;
  S.domain = "point cloud";
  S.normals = given;
  if (given.rows() != points.rows()) {
    S.normals = estimated_normals(points, neighbours);
    report.warn("the point cloud has no normals; they were estimated, outward at its top");
  }
  for (auto n : S.normals.rowwise()) n = normalized_or_z(n.transpose()).transpose();

  const auto triangles = local_triangles(points, S.normals, neighbours);
  if (triangles.empty())
    throw InputError("no triangle can be made between neighbouring points of the cloud");
  PolygonSoup soup;
  soup.points = points;
  std::vector<double> weight;
  for (const auto& [corners, count] : triangles) {
    std::array<int, 3> c = corners;
    Vec3 normal = Vec3::Zero();
    for (int v : c) normal += S.normals.row(v).transpose();
    const Vec3 a = points.row(c[0]), b = points.row(c[1]), d = points.row(c[2]);
    if ((b - a).cross(d - a).dot(normal) < 0) std::swap(c[1], c[2]);
    soup.add_face(c);
    weight.push_back(count / 3.0);
  }
  S.refined = std::make_shared<const SurfaceMesh>(std::move(soup));
  Report inner;  // its warnings are about meshes
  auto cells = std::make_shared<IntrinsicTriangulation>(intrinsic_triangulation(*S.refined, inner));
  cells->orientation.assign(cells->orientation.size(), 1);
  double sum = 0;
  for (int e = 0; e < cells->n_edges(); ++e)
    sum += (points.row(cells->edges(e, 0)) / cells->unit -
            points.row(cells->edges(e, 1)) / cells->unit)
               .norm();
  S.spacing = sum / cells->n_edges();
  S.place = S.cells = cells;
  S.weight = Eigen::Map<const VecX>(weight.data(), static_cast<Eigen::Index>(weight.size()));
  S.P.resize(points.rows(), points.rows());
  S.P.setIdentity();
  S.patch_normals.resize(cells->n_faces(), 3);
  for (int t = 0; t < cells->n_faces(); ++t) {
    S.patch_offsets.push_back(t);
    Vec3 normal = Vec3::Zero();
    for (int k = 0; k < 3; ++k) normal += S.normals.row(cells->faces(t, k)).transpose();
    S.patch_normals.row(t) = normalized_or_z(normal);
  }
  S.patch_offsets.push_back(cells->n_faces());
  return S;
}

}  // namespace littoral
