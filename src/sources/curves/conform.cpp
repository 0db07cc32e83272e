#include "sources/curves/conform.h"

#include <cmath>
#include <string>

#include "base/counted.h"
#include "littoral/error.h"

namespace littoral {

namespace {

VecX count_edges(const CutMesh& cut) {
  VecX times = VecX::Zero(cut.mesh.n_edges());
  for (const auto& path : cut.path)
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const int e = cut.mesh.find_edge(path[i], path[i + 1]);
      if (e >= 0) times[e] += cut.mesh.edges()(e, 0) == path[i] ? 1 : -1;
    }
  return times;
}

/// Halves segments that lie on a single edge both of whose ends are ends of the chain; true if
/// there are any.
bool halve_lonely(const CutMesh& cut, const VecX& times, std::vector<CutSegment>& segments) {
  VecX boundary = VecX::Zero(cut.mesh.n_vertices());
  for (int e = 0; e < cut.mesh.n_edges(); ++e) {
    boundary[cut.mesh.edges()(e, 0)] -= times[e];
    boundary[cut.mesh.edges()(e, 1)] += times[e];
  }
  const std::size_t n = segments.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& path = cut.path[i];
    if (path.size() != 2 || boundary[path[0]] == 0 || boundary[path[1]] == 0) continue;
    CutSegment& first = segments[i];
    CutSegment second = first;
    for (int k = 0; k < 3; ++k) first.b[k] = second.a[k] = (first.a[k] + first.b[k]) / 2;
    segments.push_back(second);
  }
  return segments.size() > n;
}

}  // namespace

std::vector<CurvePiece> pieces_with_sides(const PlacedSources& sources) {
  std::vector<CurvePiece> pieces;
  for (const CurvePiece& piece : sources.pieces)
    if (piece.is_signed) pieces.push_back(piece);
  return pieces;
}

std::vector<CurvePiece> signed_pieces(const PlacedSources& sources, Report& report) {
  std::vector<CurvePiece> pieces = pieces_with_sides(sources);
  const std::size_t left_out = sources.points.size() + sources.pieces.size() - pieces.size();
  if (left_out > 0)
    report.warn("pieces-left-out", counted(left_out, "point or piece of an unsigned curve was",
                                           "points and pieces of unsigned curves were") +
                                       " left out: only signed curves have sides");
  if (pieces.empty())
    throw InputError(
        "winding numbers need signed curves (keyword signed_curve of .txt files); there are none",
        "nothing-given");
  return pieces;
}

ConformingCurves conform(const SurfaceMesh& mesh, const std::vector<CurvePiece>& pieces) {
  std::vector<CutSegment> segments;
  for (const CurvePiece& piece : pieces)
    segments.push_back(
        {piece.face, piece.left ? piece.a : piece.b, piece.left ? piece.b : piece.a});
  CutMesh cut = cut_mesh(mesh, segments);
  VecX times = count_edges(cut);
  if (halve_lonely(cut, times, segments)) {
    cut = cut_mesh(mesh, segments);
    times = count_edges(cut);
  }
  const bool is_cut = cut.mesh.n_vertices() > mesh.n_vertices();
  return {std::move(cut), std::move(times), is_cut};
}

}  // namespace littoral
