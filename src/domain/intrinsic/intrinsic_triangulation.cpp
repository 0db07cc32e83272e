#include "domain/intrinsic/intrinsic_triangulation.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "base/counted.h"
#include "base/disjoint_sets.h"
#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/parallel_sum.h"
#include "domain/intrinsic/lengthened_sides.h"
#include "domain/mesh/edge_sides.h"
#include "domain/mesh/face_orientation.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr std::size_t face_grain = 16384, edge_grain = 16384;
constexpr std::size_t fetched_ahead = 6;  // faces and edges: points are read in any order

void take_faces(const SurfaceMesh& mesh, IntrinsicTriangulation& T, Report& report) {
  const int n = mesh.n_faces();
  std::atomic<bool> all_distinct{n > 0};
  T.along.resize(n, 3);
  parallel_for(std::size_t(n), face_grain, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index f = index(begin); f < index(end); ++f) {
      for (int k = 0; k < 3; ++k) T.along(f, k) = mesh.side_along(int(f), k) ? 1 : -1;
      if (!mesh.has_distinct_corners(int(f))) all_distinct = false;
    }
  });
  T.faces = mesh.shared_faces();
  T.side_edge = mesh.shared_side_edges();
  T.triangle_of_face = FaceTriangles(n);
  if (all_distinct) return;

  std::vector<int> kept, triangle_of_face(std::size_t(n), -1);
  for (int f = 0; f < n; ++f) {
    if (!mesh.has_distinct_corners(f)) continue;
    triangle_of_face[f] = int_size(kept);
    kept.push_back(f);
  }
  if (kept.empty())
    throw InputError("the mesh has no face with three different vertices", "empty-input");
  report.warn("degenerate-faces", counted(n - int_size(kept), "face that repeats a vertex was",
                                          "faces that repeat a vertex were") +
                                      " left out");
  T.triangle_of_face = FaceTriangles(std::move(triangle_of_face));
  T.faces = SharedRows<int, 3>(T.faces.matrix()(kept, Eigen::all));
  T.side_edge = SharedRows<int, 3>(T.side_edge.matrix()(kept, Eigen::all));
  T.along = Rows<std::int8_t, 3>(T.along(kept, Eigen::all));
}

/// Lowest and highest coordinates of the triangles.
std::pair<Vec3, Vec3> bounds_of(const SurfaceMesh& mesh, const IntrinsicTriangulation& T) {
  const auto n = std::size_t(T.n_faces());
  using Bounds = std::pair<Vec3, Vec3>;
  const Bounds none(Vec3::Constant(infinity), Vec3::Constant(-infinity));
  const auto bounds = [&](std::size_t begin, std::size_t end) {
    auto [low, high] = none;
    for (std::size_t f = begin; f < end; ++f)
      for (int k = 0; k < 3; ++k) {
        if (f + fetched_ahead < n)
          fetch_ahead(&mesh.points()(T.faces(index(f + fetched_ahead), k), 0));
        const Vec3 p = mesh.point(T.faces(index(f), k));
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    return Bounds(low, high);
  };
  return of_pieces(n, face_grain, none, bounds, [](const Bounds& a, const Bounds& b) {
    return Bounds(a.first.cwiseMin(b.first), a.second.cwiseMax(b.second));
  });
}

void measure(const SurfaceMesh& mesh, const EdgeSides& sides, IntrinsicTriangulation& T,
             Report& report) {
  const auto [low, high] = bounds_of(mesh, T);
  const double extent = (0.5 * high - 0.5 * low).maxCoeff();  // halved first: must not overflow
  if (!(extent > 0))
    throw InputError("the mesh has no extent: all its vertices are at one point", "empty-input");
  if (extent < 1e-290)
    throw InputError("the mesh is too small for double precision (it extends over " +
                     number_text(extent) + "); scale it up");
  T.unit = std::exp2(std::floor(std::log2(extent)));

  VecX edge_length(T.n_edges());
  T.edge_use.resize(T.n_edges());
  parallel_for(T.edge_use.size(), edge_grain, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index e = index(begin); e < index(end); ++e) {
      if (const Eigen::Index next = e + index(fetched_ahead); next < T.n_edges()) {
        fetch_ahead(&mesh.points()(T.edges(next, 0), 0));
        fetch_ahead(&mesh.points()(T.edges(next, 1), 0));
      }
      const Vec3 d = mesh.point(T.edges(e, 1)) / T.unit - mesh.point(T.edges(e, 0)) / T.unit;
      edge_length[e] = d.norm();
      const std::size_t use = sides.at(int(e)).size();
      T.edge_use[e] = static_cast<std::uint8_t>(std::min<std::size_t>(255, use));
    }
  });
  double sum = 0;
  int used = 0;
  for (int e = 0; e < T.n_edges(); ++e) {
    if (!T.edge_use[e]) continue;
    sum += edge_length[e];
    ++used;
  }
  T.mean_edge_length = sum / used;

  T.length.resize(T.n_faces(), 3);
  parallel_for(std::size_t(T.n_faces()), face_grain, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index f = index(begin); f < index(end); ++f)
      for (int k = 0; k < 3; ++k) T.length(f, k) = edge_length[T.side_edge(f, k)];
  });
  const int lengthened = lengthen_sides(T, 1e-10);
  if (lengthened > 0)
    report.warn("degenerate-faces",
                counted(lengthened, "face without area", "faces without area") +
                    " (to a relative 1e-10) had their sides lengthened minimally");
}

void take_orientation(const SurfaceMesh& mesh, IntrinsicTriangulation& T) {
  const FaceOrientation& oriented = face_orientation(mesh);
  T.orientation.resize(T.n_faces());
  for (int f = 0; f < mesh.n_faces(); ++f)
    if (const int t = T.triangle_of_face[f]; t >= 0) T.orientation[t] = oriented.sign[f];
}

/// Unit vector from side k of f into the face, in space; zero if the face is degenerate.
Vec3 into_face(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, int f, int k) {
  const Vec3 a = mesh.point(T.faces(f, k)) / T.unit,
             b = mesh.point(T.faces(f, (k + 1) % 3)) / T.unit;
  const Vec3 c = mesh.point(T.faces(f, (k + 2) % 3)) / T.unit;
  const Vec3 e = (b - a).stableNormalized();
  return ((c - a) - e.dot(c - a) * e).stableNormalized();
}

/// Decides on which side of each edge its faces lie in the edge's frame, and marks the faces whose
/// own frame says otherwise. Two faces lie on opposite sides; where more meet, those that leave the
/// edge in the direction of the first (to 90 degrees) lie on its side.
void mark_seams(const SurfaceMesh& mesh, IntrinsicTriangulation& T, const EdgeSides& sides) {
  const auto n = std::size_t(T.n_edges());
  std::vector<std::vector<TriangleSide>> found((n + edge_grain - 1) / edge_grain);
  auto left = [&](const TriangleSide& s) {
    return T.orientation[s.face()] * T.along(s.face(), s.k());
  };
  parallel_for(n, edge_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const auto at = sides.at(int(e));
      for (std::size_t i = 1; i < at.size(); ++i) {
        bool same_side = false;
        if (at.size() > 2) {
          const Vec3 first = into_face(mesh, T, at[0].face(), at[0].k());
          same_side = first.dot(into_face(mesh, T, at[i].face(), at[i].k())) > 1e-9;
        }
        const int wanted = same_side ? left(at[0]) : -left(at[0]);
        if (left(at[i]) != wanted) found[begin / edge_grain].push_back(at[i]);
      }
    }
  });
  for (const auto& sides_found : found)
    for (const TriangleSide& side : sides_found) {
      if (!T.has_seams()) T.seams = Rows<std::uint8_t, 3>::Zero(T.n_faces(), 3);
      T.seams(side.face(), side.k()) = 1;
    }
}

void find_components(const SurfaceMesh& mesh, IntrinsicTriangulation& T) {
  if (T.n_faces() == mesh.n_faces()) {
    T.component = mesh.vertex_component();
    T.n_components = mesh.n_components();
    return;
  }
  DisjointSets vertices(T.n_vertices);
  std::vector<char> used(T.n_vertices, 0);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      used[T.faces(f, k)] = 1;
      vertices.join(T.faces(f, 0), T.faces(f, k));
    }
  T.component = vertices.numbered(T.n_components, used);
}

}  // namespace

IntrinsicTriangulation intrinsic_triangulation(const SurfaceMesh& mesh, Report& report) {
  if (!mesh.is_triangle_mesh())
    throw UnsupportedError(
        "the mesh has polygons with more than three corners; cut them into triangles first");
  IntrinsicTriangulation T;
  T.n_vertices = mesh.n_vertices();
  T.edges = mesh.shared_edges();
  take_faces(mesh, T, report);
  EdgeSides sides;
  parallel_for(2, 1, [&](std::size_t half, std::size_t) {  // neither needs anything of the other
    if (half == 0) {
      sides = edge_sides(T);
    } else {
      take_orientation(mesh, T);
      find_components(mesh, T);
    }
  });
  measure(mesh, sides, T, report);
  mark_seams(mesh, T, sides);
  return T;
}

}  // namespace littoral
