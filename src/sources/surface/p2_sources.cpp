#include "sources/surface/p2_sources.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/option_table.h"
#include "littoral/error.h"
#include "sources/surface/known_distances.h"
#include "sources/surface/surface_points.h"

namespace littoral {

namespace {

constexpr double least_spacing = 1e-3;  // many samples in one triangle say nothing more

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
    if (source.where.empty()) return;
    const auto& [element, b] = source.where.front();
    std::vector<Vec3>& before = points_[element];
    const auto same = [&, here = b](const Vec3& other) {
      return (other - here).cwiseAbs().maxCoeff() < 1e-9;
    };
    if (std::any_of(before.begin(), before.end(), same)) return;
    before.push_back(b);
    sources_.push_back(std::move(source));
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
    sources_.push_back(std::move(source));
  }

  /// Pieces of a curve, of which the nodes around it are to know their distance.
  void add_around(std::span<const CurvePiece> pieces) {
    for (const CurvePiece& piece : pieces)
      for (const TriangleSources::Segment& segment : segments_of(mesh_, T_, piece))
        around_.push_back(segment);
  }

  std::vector<P2Source<2>> take() {
    for (const NodeDistance& at : distances_around(T_, around_, TriangleNodes::corners_and_middles))
      sources_.push_back({{{at.triangle, at.b}}, true, at.distance});
    return std::move(sources_);
  }

 private:
  std::vector<P2Source<2>> sources_;
  std::map<int, std::vector<Vec3>> points_;  // element -> points in it, so that each counts once
  std::vector<TriangleSources::Segment> around_;
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
      const double along = length * (next / count) - before;
      if (along > piece.length && !(last && next == count)) break;
      out.add_on(piece, piece.length > 0 ? std::clamp(along / piece.length, 0.0, 1.0) : 0);
    }
    before += piece.length;
  }
}

}  // namespace

std::vector<P2Source<2>> p2_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                    const PlacedSources& sources, double spacing) {
  if (spacing > 0 && spacing < least_spacing)
    throw InputError("option spacing: " + number_text(spacing) + " is neither 0 nor at least " +
                         number_text(least_spacing),
                     "option-value");
  const VecX h = mean_edge_lengths(T);
  Builder out(mesh, T);
  for (const SurfacePoint& p : sources.points) out.add_point(p);
  const std::span<const CurvePiece> pieces = sources.pieces;
  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    while (end < pieces.size() && pieces[end].curve == pieces[begin].curve) ++end;
    const auto curve = pieces.subspan(begin, end - begin);
    const auto on = std::find_if(curve.begin(), curve.end(), [&](const CurvePiece& piece) {
      return T.triangle_of_face[piece.face] >= 0;
    });
    if (on == curve.end()) continue;
    const int component = T.component[T.faces(T.triangle_of_face[on->face], 0)];
    if (spacing > 0)
      sample(curve, spacing * h[component] * T.unit, out);
    else
      out.add_around(curve);
  }
  std::vector<P2Source<2>> all = out.take();
  if (all.empty())
    throw InputError("no source lies on a face with three different vertices", "nothing-there");
  return all;
}

}  // namespace littoral
