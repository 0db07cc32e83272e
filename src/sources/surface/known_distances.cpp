#include "sources/surface/known_distances.h"

#include <algorithm>
#include <cmath>
#include <compare>

namespace littoral {

namespace {

constexpr double at_node = 1e-12;  // of the triangle's size

/// Of x from a segment, in the plane or in space.
template <class Point>
double distance_to_segment(const Point& x, const Point& a, const Point& b) {
  const double length2 = (b - a).squaredNorm();
  const double s = length2 > 0 ? (x - a).dot(b - a) / length2 : 0;
  return (x - a - std::clamp(s, 0.0, 1.0) * (b - a)).norm();
}

Vec2 on(const TriangleShape& t, const Vec3& b) {
  const Complex z = b[0] * t.p[0] + b[1] * t.p[1] + b[2] * t.p[2];
  return {z.real(), z.imag()};
}

Vec3 barycentrics(const std::array<double, 3>& b) { return {b[0], b[1], b[2]}; }

void know(KnownDistances& known, int node, double distance) {
  const auto [at, fresh] = known.try_emplace(node, distance);
  if (!fresh) at->second = std::min(at->second, distance);
}

bool from_corner_to_corner(const TriangleSources::Segment& s) {
  return barycentrics(s.a).maxCoeff() == 1 && barycentrics(s.b).maxCoeff() == 1;
}

/// Where segments end within a side, in the triangles at that side where none does: the tips of
/// curves, and pages at an edge of three and more faces.
std::vector<TriangleSources::Segment> ends_on_sides(
    const IntrinsicTriangulation& T, std::span<const TriangleSources::Segment> segments) {
  struct End {
    int edge;
    double share;  // of the way to its head
    int triangle;
    auto operator<=>(const End&) const = default;
  };
  std::vector<End> ends;
  for (const TriangleSources::Segment& s : segments) {
    if (s.triangle < 0) continue;
    for (const auto& b : {s.a, s.b})
      for (int k = 0; k < 3; ++k) {
        const double here = b[k], next = b[(k + 1) % 3];
        if (b[(k + 2) % 3] <= at_node && std::min(here, next) > at_node)
          ends.push_back(
              {T.side_edge(s.triangle, k), T.along(s.triangle, k) > 0 ? next : here, s.triangle});
      }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<TriangleSources::Segment> out;
  for (int f = 0; f < T.n_faces() && !ends.empty(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int edge = T.side_edge(f, k);
      const auto less = [](const End& end, int e) { return end.edge < e; };
      auto near = std::lower_bound(ends.begin(), ends.end(), edge, less);
      for (auto at = near; at != ends.end() && at->edge == edge; ++at) {
        while (near->share < at->share - at_node) ++near;
        bool own = false;
        for (auto o = near; o != ends.end() && o->edge == edge && o->share <= at->share + at_node;
             ++o)
          own = own || o->triangle == f;
        if (own) continue;
        std::array<double, 3> b{};
        b[(k + 1) % 3] = T.along(f, k) > 0 ? at->share : 1 - at->share;
        b[k] = 1 - b[(k + 1) % 3];
        out.push_back({f, b, b});
      }
    }
  return out;
}

/// Points inside triangles as segments without length.
std::vector<TriangleSources::Segment> with_points(const TriangleSources& sources) {
  std::vector<TriangleSources::Segment> all = sources.segments;
  for (const PointInFace& p : sources.isolated.inside) all.push_back({p.face, p.b, p.b});
  return all;
}

}  // namespace

std::vector<NodeDistance> distances_around(const IntrinsicTriangulation& T,
                                           std::span<const TriangleSources::Segment> segments,
                                           TriangleNodes nodes) {
  std::map<int, NodeDistance> at;
  const auto know_around = [&](const TriangleSources::Segment& segment) {
    const int f = segment.triangle;
    if (f < 0) return;
    const TriangleShape shape = T.shape(f);
    const Vec2 start = on(shape, barycentrics(segment.a)), end = on(shape, barycentrics(segment.b));
    for (int i = 0; i < (nodes == TriangleNodes::corners ? 3 : 6); ++i) {
      const Vec3 b =
          i < 3 ? Vec3(Vec3::Unit(i)) : Vec3(0.5 * (Vec3::Unit(i - 3) + Vec3::Unit((i - 2) % 3)));
      const int node = i < 3 ? T.faces(f, i) : T.n_vertices + T.side_edge(f, i - 3);
      const NodeDistance found{node, f, b, distance_to_segment(on(shape, b), start, end)};
      const auto [known, fresh] = at.try_emplace(node, found);
      if (!fresh && found.distance < known->second.distance) known->second = found;
    }
  };
  for (const TriangleSources::Segment& segment : segments) know_around(segment);
  for (const TriangleSources::Segment& segment : ends_on_sides(T, segments)) know_around(segment);
  std::vector<NodeDistance> out;
  for (const auto& [node, found] : at) out.push_back(found);
  return out;
}

KnownDistances known_distances(const IntrinsicTriangulation& T, const TriangleSources& sources,
                               TriangleNodes nodes) {
  std::vector<TriangleSources::Segment> through, along;
  for (const TriangleSources::Segment& segment : with_points(sources))
    (from_corner_to_corner(segment) ? along : through).push_back(segment);
  KnownDistances known;
  for (const NodeDistance& at : distances_around(T, through, nodes))
    know(known, at.node, at.distance);
  for (const NodeDistance& at : distances_around(T, along, nodes))
    if (at.distance <= at_node * T.length.row(at.triangle).maxCoeff()) know(known, at.node, 0);
  for (const int v : sources.isolated.vertices) know(known, v, 0);
  return known;
}

KnownDistances known_distances(const NodalSurface& S, const TriangleSources& sources) {
  const SurfaceMesh& mesh = *S.refined;
  const double unit = S.place->unit;
  const auto node = [&](int i) { return Vec3(mesh.point(i) / unit); };
  KnownDistances known;
  using Row = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;
  const auto from_vertex = [&](int v) {
    for (Row it(S.P, v); it; ++it) know(known, it.col(), (node(it.col()) - node(v)).norm());
  };
  for (const TriangleSources::Segment& segment : with_points(sources)) {
    const auto corners = S.place->faces.row(segment.triangle);
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    double size = 0;
    for (int k = 0; k < 3; ++k) {
      a += segment.a[k] * node(corners[k]);
      b += segment.b[k] * node(corners[k]);
      size = std::max(size, (node(corners[k]) - node(corners[(k + 1) % 3])).norm());
    }
    bool along = from_corner_to_corner(segment);
    for (int k = 0; k < 3; ++k)  // the middles of polygons are no nodes
      along = along && (corners[k] < S.n_nodes() || (segment.a[k] == 0 && segment.b[k] == 0));
    for (int k = 0; k < 3; ++k)
      for (Row it(S.P, corners[k]); it; ++it) {
        const double distance = distance_to_segment(node(it.col()), a, b);
        if (!along)
          know(known, it.col(), distance);
        else if (distance <= at_node * size)
          know(known, it.col(), 0);
      }
  }
  for (const int v : sources.isolated.vertices) from_vertex(v);
  return known;
}

}  // namespace littoral
