#include "sources/space/space_distances.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "base/index.h"
#include "operators/grid.h"
#include "solve/direct/definite.h"
#include "sources/space/surface_in_tets.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr int discs_tried = 8;

Vec3 nearest_on_disc(const Vec3& x, const Vec3& centre, const Vec3& normal, double area) {
  const Vec3 along = x - centre - normal.dot(x - centre) * normal;
  const double radius = std::sqrt(area / std::numbers::pi), length = along.norm();
  return centre + (length > radius ? Vec3(radius / length * along) : along);
}

/// What of the triangles that hold samples lies in the tets: in those with samples and in those
/// that share a vertex with one.
PolygonSoup inside(const TetMesh& mesh, const NearestSource& nearest, const OrientedPoints& samples,
                   const std::vector<TetPoint>& places) {
  std::map<int, std::set<int>> triangles_at;  // vertex -> triangles
  for (std::size_t i = 0; i < places.size(); ++i)
    for (int k = 0; k < 4 && places[i].tet >= 0; ++k)
      triangles_at[mesh.tets(places[i].tet, k)].insert(nearest.triangle_at(samples.points.row(i)));
  std::vector<Vec3> corners;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    std::set<int> here;
    for (int k = 0; k < 4; ++k)
      if (const auto at = triangles_at.find(mesh.tets(t, k)); at != triangles_at.end())
        here.insert(at->second.begin(), at->second.end());
    for (const int f : here) {
      const std::vector<Vec3> p = part_in_tet(mesh, t, nearest.corners(f));
      for (std::size_t k = 1; k + 1 < p.size(); ++k)
        corners.insert(corners.end(), {p[0], p[k], p[k + 1]});
    }
  }
  PolygonSoup soup;
  soup.points.resize(corners.size(), 3);
  for (int v = 0; v < soup.points.rows(); ++v) {
    soup.points.row(v) = corners[v];
    if (v % 3 == 2) soup.add_face(std::array{v - 2, v - 1, v});
  }
  return soup;
}

/// Is the straight way from a node of the tets to q within them, as far as some of it tells?
bool reaches(const TetLocator& locator, const Vec3& x, const Vec3& q) {
  for (const double s : {1.0, 0.75, 0.5, 0.25})
    if (locator.locate(x + s * (q - x)).tet < 0) return false;
  return true;
}

}  // namespace

NearestSource::NearestSource(const PolygonSoup& triangles, const OrientedPoints& samples)
    : samples_(samples) {
  if (triangles.n_faces() == 0) {
    centres_.emplace(samples.points);
    return;
  }
  const PolygonSoup soup = triangulate(triangles);
  points_ = soup.points;
  faces_ = triangles_of(soup);
  triangles_.emplace(points_, faces_);
}

Vec3 NearestSource::operator()(const Vec3& x) const {
  if (triangles_) return triangles_->closest_point(x).point;
  std::array<Neighbour, discs_tried> found;
  Vec3 best = Vec3::Constant(infinity);
  const int n = centres_->nearest(x, discs_tried, found.data());
  for (int i = 0; i < n; ++i) {
    const int p = found[i].point;
    const Vec3 q =
        nearest_on_disc(x, samples_.points.row(p), samples_.normals.row(p), samples_.areas[p]);
    if (!((q - x).squaredNorm() >= (best - x).squaredNorm())) best = q;
  }
  return best;
}

int NearestSource::triangle_at(const Vec3& x) const { return triangles_->closest_point(x).face; }

std::array<Vec3, 3> NearestSource::corners(int triangle) const {
  return {points_.row(faces_(triangle, 0)), points_.row(faces_(triangle, 1)),
          points_.row(faces_(triangle, 2))};
}

KnownDistances known_distances(const Grid& grid, const NearestSource& nearest,
                               const OrientedPoints& samples) {
  KnownDistances known;
  for (const int i : unknowns_of(grid_rows(grid, samples.points, samples.areas).A)) {
    const int nx = grid.n[0], ny = grid.n[1];
    const Vec3 x = grid.point(i % nx, i / nx % ny, i / nx / ny);
    known.emplace(i, (nearest(x) - x).norm());
  }
  return known;
}

std::map<int, TetNodeDistance> distances_around(const TetMesh& mesh, const TetLocator& locator,
                                                const PolygonSoup& surface,
                                                const OrientedPoints& samples,
                                                const std::vector<TetPoint>& places,
                                                const std::vector<Eigen::Vector4d>& local,
                                                const std::function<int(int, int)>& node,
                                                Around around) {
  std::set<int> holding;
  std::vector<Eigen::Index> within;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].tet >= 0) {
      holding.insert(places[i].tet);
      within.push_back(i);
    }
  std::map<int, TetNodeDistance> at;
  if (within.empty()) return at;
  if (around == Around::with_neighbours) {
    std::vector<char> touched(mesh.n_vertices(), 0);
    for (const int t : holding)
      for (int k = 0; k < 4; ++k) touched[mesh.tets(t, k)] = 1;
    for (int t = 0; t < mesh.n_tets(); ++t)
      for (int k = 0; k < 4; ++k)
        if (touched[mesh.tets(t, k)]) holding.insert(t);
  }
  const OrientedPoints kept{samples.points(within, Eigen::all), samples.normals(within, Eigen::all),
                            samples.areas(within)};
  const NearestSource nearest(surface, kept);
  std::optional<NearestSource> in_tets;
  for (const int t : holding)
    for (std::size_t i = 0; i < local.size(); ++i) {
      const auto [known, fresh] =
          at.try_emplace(node(t, i), TetNodeDistance{t, local[i], infinity});
      if (!fresh) continue;
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < 4; ++k) x += local[i][k] * mesh.points.row(mesh.tets(t, k)).transpose();
      Vec3 q = nearest(x);
      if (surface.n_faces() > 0 && !reaches(locator, x, q)) {
        if (!in_tets) in_tets.emplace(inside(mesh, nearest, samples, places), kept);
        q = (*in_tets)(x);
      }
      known->second.distance = (q - x).norm();
    }
  return at;
}

}  // namespace littoral
