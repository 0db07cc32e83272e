#include "littoral/sources/p2_sources.h"

#include <algorithm>
#include <cmath>

#include "littoral/base/error.h"
#include "littoral/sources/surface_points.h"

namespace littoral {

namespace {

class Builder {
 public:
  Builder(const SurfaceMesh& mesh, const IntrinsicTriangulation& T) : mesh_(mesh), T_(T) {}

  void add_point(const SurfacePoint& p) {
    P2Source<2> source;
    for (int face : faces_at(mesh_, p)) {
      const auto b = barycentrics_in(mesh_, p, face);
      if (T_.triangle_of_face[face] < 0 || !b) continue;
      source.where.push_back({T_.triangle_of_face[face], {(*b)[0], (*b)[1], (*b)[2]}});
    }
    if (!source.where.empty()) sources.push_back(std::move(source));
  }

  /// The point at fraction s of a piece.
  void add_on(const CurvePiece& piece, double s) {
    const int triangle = T_.triangle_of_face[piece.face];
    if (triangle < 0) return;
    P2Source<2> source;
    source.on_curve = true;
    P2Point<2> point{triangle, {}};
    for (int k = 0; k < 3; ++k) point.b[k] = (1 - s) * piece.a[k] + s * piece.b[k];
    source.where.push_back(point);
    sources.push_back(std::move(source));
  }

  std::vector<P2Source<2>> sources;

 private:
  const SurfaceMesh& mesh_;
  const IntrinsicTriangulation& T_;
};

/// Samples of one curve at equal distances of at most `step`, both ends included.
void sample(std::span<const CurvePiece> pieces, double step, Builder& out) {
  double length = 0;
  for (const CurvePiece& piece : pieces) length += piece.length;
  const double count = std::max(1.0, std::ceil(length / step));
  double before = 0, next = 0;  // distance along the curve, number of the next sample
  for (const CurvePiece& piece : pieces) {
    const bool last = &piece == &pieces.back();
    for (; next <= count; ++next) {
      const double s = (length * (next / count) - before) / piece.length;
      if (s > 1 && !(last && next == count)) break;
      out.add_on(piece, std::clamp(s, 0.0, 1.0));
    }
    before += piece.length;
  }
}

}  // namespace

std::vector<P2Source<2>> p2_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                    const PreparedSources& sources, double spacing) {
  Builder out(mesh, T);
  for (const SurfacePoint& p : sources.points) out.add_point(p);
  const std::span<const CurvePiece> pieces = sources.pieces;
  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    while (end < pieces.size() && pieces[end].curve == pieces[begin].curve) ++end;
    const auto curve = pieces.subspan(begin, end - begin);
    if (spacing > 0) {
      sample(curve, spacing * T.mean_edge_length * T.unit, out);
      continue;
    }
    for (const CurvePiece& piece : curve)
      for (double s : {0.0, 0.5, 1.0}) out.add_on(piece, s);
  }
  if (out.sources.empty())
    throw InputError("no source lies on a face with three different vertices");
  return std::move(out.sources);
}

}  // namespace littoral
