#include "sources/curves/curve_ends.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "base/disjoint_sets.h"
#include "sources/surface/surface_points.h"

namespace littoral {

namespace {

constexpr double apart = 1e-6;  // of the longest side around: cutting merges what is much nearer

enum class Rim : char { none, touches, lies_on };

class EndSearch {
 public:
  EndSearch(const SurfaceMesh& mesh, const IntrinsicTriangulation& T)
      : mesh_(mesh), T_(T), at_rim_(std::size_t(mesh.n_vertices()), 0) {
    for (int e = 0; e < T.n_edges(); ++e)
      if (T.edge_use[e] != 2) at_rim_[T.edges(e, 0)] = at_rim_[T.edges(e, 1)] = 1;
  }

  /// Does a point lie on a boundary, or could cutting move it there?
  Rim rim(const SurfacePoint& p) const {
    if (p.on == SurfacePoint::On::vertex) return at_rim_[p.element] ? Rim::lies_on : Rim::none;
    if (p.on == SurfacePoint::On::edge && T_.edge_use[p.element] != 2) return Rim::lies_on;
    for (const int face : faces_at(mesh_, p))
      for (const int v : mesh_.face(face))
        if (at_rim_[v]) return Rim::touches;
    return Rim::none;
  }

  double longest_side(const SurfacePoint& p) const {
    double longest = 0;
    for (const int face : faces_at(mesh_, p))
      if (const int t = T_.triangle_of_face[face]; t >= 0)
        longest = std::max(longest, T_.unit * T_.length.row(t).maxCoeff());
    return longest;
  }

 private:
  const SurfaceMesh& mesh_;
  const IntrinsicTriangulation& T_;
  std::vector<char> at_rim_;  // vertices
};

}  // namespace

std::vector<OpenEnd> open_ends(const PlacedSources& sources, const std::vector<char>& marked) {
  struct Place {
    SurfacePoint at;
    std::vector<int> curves;  // that start or end there
  };
  std::map<std::tuple<int, int, std::array<double, 3>>, Place> places;
  DisjointSets joined(static_cast<int>(sources.nodes.size()));
  for (int c = 0; c < joined.size(); ++c) {
    if (!marked[c]) continue;
    for (const SurfacePoint& p : {sources.nodes[c].front(), sources.nodes[c].back()}) {
      const bool vertex = p.on == SurfacePoint::On::vertex;
      const std::tuple key(static_cast<int>(p.on), p.element,
                           vertex ? std::array<double, 3>{} : p.b);
      Place& place = places[key];
      place.at = p;
      place.curves.push_back(c);
      joined.join(place.curves.front(), c);
    }
  }
  std::vector<OpenEnd> ends;
  for (const auto& [key, place] : places)
    if (place.curves.size() % 2 == 1) ends.push_back({place.at, joined.find(place.curves.front())});
  return ends;
}

std::optional<CurveEnds> curve_ends(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                    const PlacedSources& sources) {
  CurveEnds out;
  std::vector<char> takes(sources.nodes.size(), 0);
  for (const CurvePiece& piece : sources.pieces) {
    if (!piece.is_signed) continue;
    if (T.triangle_of_face[piece.face] < 0) return {};
    if (piece.edge >= 0 && T.edge_use[piece.edge] > 2) return {};
    takes[piece.curve] = 1;
    out.length += piece.length;
  }
  const std::vector<OpenEnd> ends = open_ends(sources, takes);
  if (ends.size() > most_ends) return {};
  const EndSearch search(mesh, T);
  out.of_component.assign(std::size_t(mesh.n_components()), 0);
  std::vector<Vec3> places;
  for (const OpenEnd& end : ends) {
    const SurfacePoint p = simplest(mesh, end.at);
    const Vec3 x = mesh.position(p);
    const double near = apart * search.longest_side(p);
    for (const Vec3& other : places)
      if ((other - x).stableNorm() <= near) return {};
    places.push_back(x);
    switch (search.rim(p)) {
      case Rim::touches:
        return {};
      case Rim::lies_on:
        break;
      case Rim::none:
        const int c = mesh.vertex_component()[mesh.face(faces_at(mesh, p).front())[0]];
        if (c >= 0) ++out.of_component[c];
    }
  }
  return out;
}

}  // namespace littoral
