#include "sources/p2_sources.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/option_table.h"
#include "littoral/error.h"
#include "sources/surface_points.h"
#include "sources/triangle_sources.h"

namespace littoral {

namespace {

constexpr double least_spacing = 1e-3;  // many samples in one triangle say nothing more

template <class B>
Complex on(const TriangleShape& t, const B& b) {
  return b[0] * t.p[0] + b[1] * t.p[1] + b[2] * t.p[2];
}

double distance_to_segment(Complex x, Complex a, Complex b) {
  const double length2 = std::norm(b - a);
  const double s = length2 > 0 ? ((x - a) * std::conj(b - a)).real() / length2 : 0;
  return std::abs(x - a - std::clamp(s, 0.0, 1.0) * (b - a));
}

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
    sources.push_back(std::move(source));
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

  /// Around the pieces of a curve: the nodes of the triangles that hold them, with the distance to
  /// the nearest piece in the same triangle.
  void add_around(std::span<const CurvePiece> pieces) {
    for (const CurvePiece& piece : pieces)
      for (const TriangleSources::Segment& segment : segments_of(mesh_, T_, piece)) {
        const int f = segment.triangle;
        if (f < 0) continue;
        const TriangleShape shape = T_.shape(f);
        for (int i = 0; i < P2Shape<2>::nodes; ++i) {
          const Vec3 b = i < 3 ? P2Shape<2>::corner(i) : P2Shape<2>::middle(i - 3);
          const int node = i < 3 ? T_.faces(f, i) : T_.n_vertices + T_.side_edge(f, i - 3);
          const double distance =
              distance_to_segment(on(shape, b), on(shape, segment.a), on(shape, segment.b));
          const auto [at, fresh] = around_.try_emplace(node, sources.size());
          if (fresh) sources.push_back({{{f, b}}, true, distance});
          P2Source<2>& known = sources[at->second];
          if (distance < known.distance) known = {{{f, b}}, true, distance};
        }
      }
  }

  std::vector<P2Source<2>> sources;

 private:
  std::map<int, std::vector<Vec3>> points_;  // element -> points in it, so that each counts once
  std::map<int, std::size_t> around_;        // node -> its place among the sources
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
    throw InputError("option spacing: 0, or at least " + number_text(least_spacing));
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
  if (out.sources.empty())
    throw InputError("no source lies on a face with three different vertices");
  return std::move(out.sources);
}

}  // namespace littoral
