#include "littoral/sources/carried_sources.h"

#include <string>

#include "littoral/sources/constraint_rows.h"
#include "littoral/sources/surface_points.h"

namespace littoral {

namespace {

/// Pieces as segments between shared nodes; isolated points are nodes after all others.
Marks marks_of(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
               const PreparedSources& sources) {
  Marks marks;
  SourceNodes nodes;
  for (std::size_t i = 0; i < sources.pieces.size(); ++i) {
    const CurvePiece& piece = sources.pieces[i];
    const int t = T.triangle_of_face[piece.face];
    if (t < 0) continue;
    auto node = [&](const std::array<double, 3>& b) {
      return nodes.id(simplest(mesh, SurfacePoint::in_face(piece.face, b[0], b[1], b[2])));
    };
    marks.segments.push_back({static_cast<int>(i), 0, 1, node(piece.a), node(piece.b),
                              piece.edge < 0 ? t : -1, piece.edge});
  }
  marks.nodes = nodes.points;
  marks.nodes.insert(marks.nodes.end(), sources.points.begin(), sources.points.end());
  for (SurfacePoint& p : marks.nodes)
    if (p.on == SurfacePoint::On::face) p.element = T.triangle_of_face[p.element];
  return marks;
}

}  // namespace

Retriangulated retriangulated(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                              const PreparedSources& sources, const RefineOptions& options,
                              Report& report, const Task& task) {
  PreparedSources kept = sources;
  std::erase_if(kept.points, [&](const SurfacePoint& p) {
    return p.on == SurfacePoint::On::face && T.triangle_of_face[p.element] < 0;
  });
  Marks marks = marks_of(mesh, T, kept);
  const std::size_t first_point = marks.nodes.size() - kept.points.size();
  Retriangulation fine = intrinsic_delaunay(mesh, T, std::move(marks), options, report, task);

  Retriangulated out{std::move(fine.mesh), std::move(fine.T), {}};
  std::vector<SurfacePoint> nodes;
  for (const SurfacePoint& p : fine.marks.nodes) nodes.push_back(simplest(out.mesh, p));
  out.sources.n_curves = kept.n_curves;
  out.sources.nodes.resize(kept.nodes.size());
  int lost = 0;
  for (const Marks::Segment& s : fine.marks.segments) {
    CurvePiece piece = kept.pieces[s.id];
    piece.face = s.edge >= 0 ? out.mesh.edge_faces(s.edge)[0] : s.face;
    piece.edge = s.edge;
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
  for (std::size_t i = first_point; i < first_point + kept.points.size(); ++i)
    out.sources.points.push_back(nodes[i]);
  if (lost) report.warn(std::to_string(lost) + " tiny pieces of curves were lost to rounding");
  return out;
}

}  // namespace littoral
