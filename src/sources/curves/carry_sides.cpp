#include "sources/curves/carry_sides.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

#include "base/counted.h"
#include "base/index.h"
#include "domain/mesh/face_orientation.h"
#include "sources/surface/surface_points.h"

namespace littoral {

namespace {

/// Left and right, from face to face.
class Transport {
 public:
  explicit Transport(const SurfaceMesh& mesh) : mesh_(mesh), orientation_(face_orientation(mesh)) {}

  const FaceOrientation& orientation() const { return orientation_; }

  /// Is the left of a curve that goes on from face f to face g through a point of both (in its
  /// simplest form) the left in both?
  bool same(const SurfacePoint& p, int f, int g) const {
    if (f == g || p.on == SurfacePoint::On::face) return true;
    if (p.on == SurfacePoint::On::edge) return agree(p.element, f, g);
    for (const bool any_edge : {false, true})
      if (const int parity = round_vertex(p.element, f, g, any_edge); parity >= 0)
        return parity == 0;
    return true;  // the faces touch at the vertex only
  }

 private:
  int left_of(int e, int f) const {
    for (int k = 0; k < 3; ++k)
      if (mesh_.side_edge(f, k) == e)
        return mesh_.side_along(f, k) ? orientation_.sign[f] : -orientation_.sign[f];
    return 0;
  }
  /// Do two faces at an edge lie on different sides of it, as both see it?
  bool agree(int e, int f, int g) const { return left_of(e, f) != left_of(e, g); }

  /// How many times, modulo 2, orientation changes on the shortest way from f to g through the
  /// faces at a vertex, across edges of two faces or of any number; -1 if there is none.
  int round_vertex(int v, int f, int g, bool any_edge) const {
    std::map<int, int> parity{{f, 0}};
    std::vector<int> queue{f};
    for (std::size_t i = 0; i < queue.size() && !parity.contains(g); ++i) {
      const int at = queue[i];
      for (int k = 0; k < 3; ++k) {
        const int e = mesh_.side_edge(at, k);
        if (mesh_.edges()(e, 0) != v && mesh_.edges()(e, 1) != v) continue;
        const auto faces = mesh_.edge_faces(e);
        if (!any_edge && faces.size() != 2) continue;
        for (const int to : faces)
          if (mesh_.has_distinct_corners(to) &&
              parity.try_emplace(to, parity[at] ^ static_cast<int>(!agree(e, at, to))).second)
            queue.push_back(to);
      }
    }
    const auto found = parity.find(g);
    return found == parity.end() ? -1 : found->second;
  }

  const SurfaceMesh& mesh_;
  const FaceOrientation& orientation_;
};

/// A signed curve's pieces, all those with one number.
struct Run {
  int first, last;
};

class Carrier {
 public:
  Carrier(const SurfaceMesh& mesh, std::vector<CurvePiece>& pieces)
      : mesh_(mesh), transport_(mesh), pieces_(pieces) {
    for (int i = 0; i < int_size(pieces); ++i) {
      if (!pieces[i].is_signed) continue;
      if (!runs_.empty() && pieces[runs_.back().last].curve == pieces[i].curve)
        runs_.back().last = i;
      else
        runs_.push_back({i, i});
    }
  }

  const FaceOrientation& orientation() const { return transport_.orientation(); }

  /// Numbers of the pieces where closed curves come back with their sides exchanged.
  std::vector<int> carry() {
    // Curves that begin where one ends are one curve.
    std::map<Key, std::vector<int>> begin_at, end_at;
    for (int r = 0; r < int_size(runs_); ++r) {
      begin_at[key(start(runs_[r].first))].push_back(r);
      end_at[key(end(runs_[r].last))].push_back(r);
    }
    std::vector<int> next(runs_.size(), -1);
    std::vector<char> follows(runs_.size(), 0);
    for (const auto& [at, ending] : end_at) {
      const auto beginning = begin_at.find(at);
      if (ending.size() != 1 || beginning == begin_at.end() || beginning->second.size() != 1)
        continue;
      next[ending[0]] = beginning->second[0];
      follows[beginning->second[0]] = 1;
    }
    std::vector<int> exchanged;
    std::vector<char> done(runs_.size(), 0);
    for (const bool loops : {false, true})
      for (int r = 0; r < int_size(runs_); ++r) {
        if (done[r] || (follows[r] && !loops)) continue;
        bool left = true;
        int at = r;
        for (; at >= 0 && !done[at]; at = next[at]) {
          done[at] = 1;
          for (int i = runs_[at].first; i <= runs_[at].last; ++i) {
            pieces_[i].left = left;
            const int to = i < runs_[at].last ? i + 1 : next[at] >= 0 ? runs_[next[at]].first : -1;
            if (to >= 0 && !same(i, to)) left = !left;
          }
        }
        if (at >= 0 && pieces_[runs_[at].first].left != left) exchanged.push_back(runs_[at].first);
      }
    return exchanged;
  }

 private:
  using Key = std::tuple<int, int, std::array<double, 3>>;
  SurfacePoint at(int face, const std::array<double, 3>& b) const {
    return simplest(mesh_, SurfacePoint::in_face(face, b[0], b[1], b[2]));
  }
  SurfacePoint start(int i) const { return at(pieces_[i].face, pieces_[i].a); }
  SurfacePoint end(int i) const { return at(pieces_[i].face, pieces_[i].b); }
  static Key key(const SurfacePoint& p) {
    return {static_cast<int>(p.on), p.element,
            p.on == SurfacePoint::On::vertex ? std::array<double, 3>{} : p.b};
  }
  bool same(int i, int to) const {
    return pieces_[i].face == pieces_[to].face ||
           transport_.same(end(i), pieces_[i].face, pieces_[to].face);
  }

  const SurfaceMesh& mesh_;
  Transport transport_;
  std::vector<CurvePiece>& pieces_;
  std::vector<Run> runs_;
};

}  // namespace

void carry_sides(const SurfaceMesh& mesh, PlacedSources& sources, Report& report) {
  if (std::none_of(sources.pieces.begin(), sources.pieces.end(),
                   [](const CurvePiece& piece) { return piece.is_signed; }))
    return;
  Carrier carrier(mesh, sources.pieces);
  const FaceOrientation& orientation = carrier.orientation();
  if (orientation.flipped > 0)
    report.warn("flipped-faces", counted(orientation.flipped, "face is", "faces are") +
                                     " oriented against the majority of neighbouring faces; the "
                                     "left side of a curve follows the majority");
  if (!orientation.orientable)
    report.warn(
        "not-orientable",
        "the surface is not orientable: the left side of a curve is that of its first face and is "
        "carried along it");
  for (const int piece : carrier.carry())
    report.warn(
        "not-orientable",
        "curve " + std::to_string(sources.pieces[piece].curve + 1) +
            " comes back to its start with its sides exchanged: it has only one, and the sign "
            "changes there; option discontinuous of signed-heat lets the distance jump");
}

}  // namespace littoral
