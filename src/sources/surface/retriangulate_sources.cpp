#include "sources/surface/retriangulate_sources.h"

#include <algorithm>
#include <string>

#include "base/counted.h"
#include "sources/surface/surface_points.h"
#include "sources/systems/constraint_rows.h"

namespace littoral {

namespace {

/// Pieces as segments between shared nodes; isolated points are nodes after all others.
CurveNetwork curve_network_of(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                              const PlacedSources& sources) {
  CurveNetwork curves;
  SourceNodes nodes;
  for (std::size_t i = 0; i < sources.pieces.size(); ++i) {
    const CurvePiece& piece = sources.pieces[i];
    const int t = T.triangle_of_face[piece.face];
    if (t < 0) continue;
    auto node = [&](const std::array<double, 3>& b) {
      return nodes.id(simplest(mesh, SurfacePoint::in_face(piece.face, b[0], b[1], b[2])));
    };
    curves.segments.push_back({static_cast<int>(i), 0, 1, node(piece.a), node(piece.b),
                               piece.edge < 0 ? t : -1, piece.edge});
  }
  curves.nodes = nodes.points;
  curves.nodes.insert(curves.nodes.end(), sources.points.begin(), sources.points.end());
  for (SurfacePoint& p : curves.nodes)
    if (p.on == SurfacePoint::On::face) p.element = T.triangle_of_face[p.element];
  return curves;
}

/// A point on all the sheets of the cover.
void add_on_sheets(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                   const CoveringMesh& cover, const SurfacePoint& p,
                   std::vector<SurfacePoint>& out) {
  if (p.on == SurfacePoint::On::vertex) {
    out.push_back(p);
  } else if (p.on == SurfacePoint::On::face) {
    const int t = T.triangle_of_face[p.element];
    if (t < 0) return;
    out.push_back(SurfacePoint::in_face(2 * t, p.b[0], p.b[1], p.b[2]));
    out.push_back(SurfacePoint::in_face(2 * t + 1, p.b[0], p.b[2], p.b[1]));
  } else {
    std::vector<int> sheets;  // edges of the cover
    for (int face : mesh.edge_faces(p.element)) {
      const int t = T.triangle_of_face[face];
      for (int k = 0; k < 3 && t >= 0; ++k) {
        if (mesh.side_edge(face, k) != p.element) continue;
        sheets.push_back(cover.mesh.side_edge(2 * t, k));
        sheets.push_back(cover.mesh.side_edge(2 * t + 1, 2 - k));
      }
    }
    std::sort(sheets.begin(), sheets.end());
    sheets.erase(std::unique(sheets.begin(), sheets.end()), sheets.end());
    for (int e : sheets) {
      const bool same = cover.mesh.edges()(e, 0) == mesh.edges()(p.element, 0);
      out.push_back(SurfacePoint::on_edge(e, same ? p.b[1] : p.b[0]));
    }
  }
}

}  // namespace

PlacedSources covering_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                               const CoveringMesh& cover, const PlacedSources& sources) {
  PlacedSources out;
  out.n_curves = sources.n_curves;
  out.nodes.resize(sources.nodes.size());
  for (CurvePiece piece : sources.pieces) {
    const int face = piece.face, t = T.triangle_of_face[face];
    if (t < 0) continue;
    piece.face = 2 * t;
    for (int k = 0; k < 3; ++k)
      if (piece.edge >= 0 && mesh.side_edge(face, k) == piece.edge) {
        piece.edge = cover.mesh.side_edge(2 * t, k);
        break;
      }
    out.pieces.push_back(piece);
  }
  for (std::size_t i = 0; i < sources.points.size(); ++i) {
    std::vector<SurfacePoint> sheets;
    add_on_sheets(mesh, T, cover, sources.points[i], sheets);
    for (const SurfacePoint& p : sheets) out.add_point(p, sources.point_value(i));
  }
  return out;
}

Retriangulated retriangulated(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                              const PlacedSources& sources, const RefineOptions& options,
                              Report& report, const Task& task) {
  PlacedSources kept = sources;
  kept.points.clear();
  kept.point_values.clear();
  for (std::size_t i = 0; i < sources.points.size(); ++i) {
    const SurfacePoint& p = sources.points[i];
    if (p.on != SurfacePoint::On::face || T.triangle_of_face[p.element] >= 0)
      kept.add_point(p, sources.point_value(i));
  }
  CurveNetwork curves = curve_network_of(mesh, T, kept);
  const std::size_t first_point = curves.nodes.size() - kept.points.size();
  Retriangulation fine = intrinsic_delaunay(mesh, T, std::move(curves), options, report, task);

  Retriangulated out{std::move(fine.mesh), std::move(fine.T), {}};
  std::vector<SurfacePoint> nodes;
  for (const SurfacePoint& p : fine.curves.nodes) nodes.push_back(simplest(out.mesh, p));
  out.sources.n_curves = kept.n_curves;
  out.sources.nodes.resize(kept.nodes.size());
  int lost = 0;
  for (const CurveNetwork::Segment& s : fine.curves.segments) {
    CurvePiece piece = kept.pieces[s.id];
    piece.face = s.edge >= 0 ? out.mesh.edge_faces(s.edge)[0] : s.face;
    piece.edge = s.edge;
    if (s.mirrored) piece.left = !piece.left;
    piece.length *= s.to - s.from;
    const auto a = barycentrics_in(out.mesh, nodes[s.a], piece.face),
               b = barycentrics_in(out.mesh, nodes[s.b], piece.face);
    if (!a || !b || !(piece.length > 0)) {
      lost += piece.length > 0;
      continue;
    }
    piece.a = *a;
    piece.b = *b;
    // Of a curve's nodes only the ends matter from here on.
    auto& ends = out.sources.nodes[piece.curve];
    if (ends.empty()) ends.push_back(nodes[s.a]);
    ends.resize(1);
    ends.push_back(nodes[s.b]);
    out.sources.pieces.push_back(piece);
  }
  for (std::size_t i = 0; i < kept.points.size(); ++i)
    out.sources.add_point(nodes[first_point + i], kept.point_value(i));
  if (lost)
    report.warn("pieces-lost",
                counted(lost, "tiny piece of a curve was", "tiny pieces of curves were") +
                    " lost to rounding");
  return out;
}

}  // namespace littoral
