#include "sources/surface/triangle_sources.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "base/index.h"
#include "littoral/error.h"
#include "sources/surface/surface_points.h"

namespace littoral {

std::vector<PointInFace> triangles_around(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                          const SurfacePoint& p, const std::vector<int>& without) {
  std::vector<PointInFace> where;
  for (int face : faces_at(mesh, p)) {
    const int t = T.triangle_of_face[face];
    if (t < 0 || std::find(without.begin(), without.end(), t) != without.end()) continue;
    if (const auto b = barycentrics_in(mesh, p, face)) where.push_back({t, *b});
  }
  return where;
}

std::vector<TriangleSources::Segment> segments_of(const SurfaceMesh& mesh,
                                                  const IntrinsicTriangulation& T,
                                                  const CurvePiece& piece) {
  std::vector<TriangleSources::Segment> all;
  const auto add = [&](int t, const std::array<double, 3>& a, const std::array<double, 3>& b,
                       bool left) {
    all.push_back({t, left ? a : b, left ? b : a, piece.is_signed});
  };
  const int own = T.triangle_of_face[piece.face];
  if (piece.edge < 0) {
    add(own, piece.a, piece.b, piece.left);
    return all;
  }
  const auto corners = mesh.face(piece.face);
  auto on_edge = [&](const std::array<double, 3>& b) {
    double head = 0;
    for (int k = 0; k < 3; ++k)
      if (corners[k] == mesh.edges()(piece.edge, 1)) head = b[k];
    return simplest(mesh, SurfacePoint::on_edge(piece.edge, head));
  };
  // Do two triangles disagree about the sides of the edge?
  auto seam = [&](int t) {
    for (int k = 0; k < 3 && t >= 0; ++k)
      if (T.side_edge(t, k) == piece.edge) return T.seam(t, k);
    return false;
  };
  const SurfacePoint p = on_edge(piece.a), q = on_edge(piece.b);
  for (int face : mesh.edge_faces(piece.edge)) {
    const int t = T.triangle_of_face[face];
    if (t < 0) continue;
    const auto a = barycentrics_in(mesh, p, face), b = barycentrics_in(mesh, q, face);
    if (a && b) add(t, *a, *b, !piece.is_signed || piece.left == (seam(t) == seam(own)));
  }
  return all;
}

namespace {

struct Numbered {
  SurfacePoint point;
  int source;
};

TriangleSources::Points sorted_out(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                   const std::vector<double>& value, std::vector<Numbered> points,
                                   std::vector<char>& reached) {
  auto key = [](const SurfacePoint& p) {
    return std::tuple(static_cast<int>(p.on), p.element,
                      p.on == SurfacePoint::On::vertex ? std::array<double, 3>{} : p.b);
  };
  for (Numbered& n : points) n.point = simplest(mesh, n.point);
  std::sort(points.begin(), points.end(), [&](const Numbered& p, const Numbered& q) {
    return std::tuple(key(p.point), value[p.source], p.source) <
           std::tuple(key(q.point), value[q.source], q.source);
  });
  const auto same = [&](const Numbered& p, const Numbered& q) {
    return key(p.point) == key(q.point);
  };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  TriangleSources::Points out;
  for (const auto& [p, source] : points) {
    const std::vector<PointInFace> where = triangles_around(mesh, T, p);
    if (where.empty()) continue;
    reached[T.component[T.faces(where.front().face, 0)]] = 1;
    if (p.on == SurfacePoint::On::vertex) {
      out.vertices.push_back(p.element);
      out.vertex_source.push_back(source);
    } else {
      out.inside.insert(out.inside.end(), where.begin(), where.end());
      out.inside_source.resize(out.inside.size(), source);
    }
  }
  return out;
}

/// Nodes of curves that are no ends of their pieces, where a step without length leads to another
/// element at the same place.
void add_other_nodes(const SurfaceMesh& mesh, const PlacedSources& sources,
                     std::vector<Numbered>& nodes) {
  std::map<int, int> first;  // curve -> its first piece
  for (int i = int_size(sources.pieces) - 1; i >= 0; --i) first[sources.pieces[i].curve] = i;
  const auto key = [&](const SurfacePoint& given) {
    const SurfacePoint p = simplest(mesh, given);
    return std::tuple(static_cast<int>(p.on), p.element,
                      p.on == SurfacePoint::On::vertex ? std::array<double, 3>{} : p.b);
  };
  std::set<std::tuple<int, int, std::array<double, 3>>> known;
  for (const Numbered& n : nodes) known.insert(key(n.point));
  for (const auto& [c, piece] : first) {
    if (c >= int_size(sources.nodes)) continue;  // pieces alone were given
    for (const SurfacePoint& p : sources.nodes[c])
      if (known.insert(key(p)).second) nodes.push_back({p, piece});
  }
}

}  // namespace

TriangleSources triangle_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                 const PlacedSources& sources) {
  TriangleSources out;
  out.reached.assign(T.n_components, 0);
  for (const CurvePiece& piece : sources.pieces) out.value.push_back(piece.value / T.unit);
  for (std::size_t i = 0; i < sources.points.size(); ++i)
    out.value.push_back(sources.point_value(i) / T.unit);
  std::vector<Numbered> nodes, isolated;
  for (std::size_t i = 0; i < sources.pieces.size(); ++i) {
    const CurvePiece& piece = sources.pieces[i];
    if (T.triangle_of_face[piece.face] < 0) continue;
    const int source = static_cast<int>(i);
    for (TriangleSources::Segment segment : segments_of(mesh, T, piece)) {
      segment.source = source;
      out.segments.push_back(segment);
    }
    for (const auto& b : {piece.a, piece.b})
      nodes.push_back({SurfacePoint::in_face(piece.face, b[0], b[1], b[2]), source});
  }
  add_other_nodes(mesh, sources, nodes);
  for (std::size_t i = 0; i < sources.points.size(); ++i)
    isolated.push_back({sources.points[i], static_cast<int>(sources.pieces.size() + i)});
  out.nodes = sorted_out(mesh, T, out.value, std::move(nodes), out.reached);
  out.isolated = sorted_out(mesh, T, out.value, std::move(isolated), out.reached);
  if (std::find(out.reached.begin(), out.reached.end(), 1) == out.reached.end())
    throw InputError("no source lies on a face with three different vertices", "nothing-there");
  return out;
}

}  // namespace littoral
