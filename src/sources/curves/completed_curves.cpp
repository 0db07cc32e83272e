#include "sources/curves/completed_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/index.h"
#include "base/stable_length.h"
#include "contour/isolines.h"
#include "sources/surface/surface_points.h"

namespace littoral {

namespace {

bool any_signed(const PlacedSources& sources) {
  return std::any_of(sources.pieces.begin(), sources.pieces.end(),
                     [](const CurvePiece& piece) { return piece.is_signed; });
}

/// The given sources, seen from nearby.
class Nearby {
 public:
  Nearby(const SurfaceMesh& mesh, const PlacedSources& sources) : mesh_(mesh) {
    std::map<std::tuple<int, int, double, double, double>, int> ends;
    const auto key = [](const SurfacePoint& p) {
      const bool vertex = p.on == SurfacePoint::On::vertex;
      return std::tuple(static_cast<int>(p.on), p.element, vertex ? 1 : p.b[0], vertex ? 0 : p.b[1],
                        vertex ? 0 : p.b[2]);
    };
    for (const auto& nodes : sources.nodes)
      for (const SurfacePoint* p : {&nodes.front(), &nodes.back()}) ++ends[key(*p)];
    const auto is_open = [&](const CurvePiece& piece, const std::array<double, 3>& b) {
      if (!piece.is_signed) return false;  // nothing continues beyond
      const auto at =
          ends.find(key(simplest(mesh, SurfacePoint::in_face(piece.face, b[0], b[1], b[2]))));
      return at != ends.end() && at->second == 1;
    };
    for (const CurvePiece& piece : sources.pieces)
      add({place(piece.face, piece.a), place(piece.face, piece.b), is_open(piece, piece.a),
           is_open(piece, piece.b)},
          piece.face);
    for (const SurfacePoint& p : sources.points)
      for (int face : faces_at(mesh, p)) add({mesh.position(p), mesh.position(p)}, face);
  }

  /// Is a source at a point's side, one that goes on both ways, in a face that shares a vertex?
  bool has_beside(int face, const Vec3& x) const {
    double least = infinity;
    bool beside = false;
    for (int v : mesh_.face(face)) {
      const auto near = around_.find(v);
      if (near == around_.end()) continue;
      for (int i : near->second) {
        const Straight& s = straight_[i];
        const Vec3 along = s.b - s.a;
        const double length = stable_length(along);
        const double t =
            length > 0 ? std::clamp((x - s.a).dot(along / length) / length, 0.0, 1.0) : 0;
        const double distance = stable_length(s.a + t * along - x);
        if (distance >= least) continue;
        least = distance;
        beside = !((t == 0 && s.open_a) || (t == 1 && s.open_b));
      }
    }
    return beside;
  }

 private:
  struct Straight {
    Vec3 a, b;
    bool open_a = false, open_b = false;
  };
  void add(const Straight& s, int face) {
    for (int v : mesh_.face(face)) around_[v].push_back(straight_.size());
    straight_.push_back(s);
  }
  Vec3 place(int face, const std::array<double, 3>& b) const {
    return mesh_.position(SurfacePoint::in_face(face, b[0], b[1], b[2]));
  }

  const SurfaceMesh& mesh_;
  std::vector<Straight> straight_;
  std::map<int, std::vector<int>> around_;  // vertex -> sources in its faces
};

}  // namespace

bool append_step(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q,
                 bool goes_on, PlacedSources& to) {
  CurvePiece piece;
  piece.is_signed = false;
  piece.face = common_face(mesh, p, q);
  piece.length = (mesh.position(q) - mesh.position(p)).stableNorm();
  if (piece.face < 0 || !(piece.length > 0)) return false;
  if (!goes_on) ++to.n_curves, to.nodes.push_back({p});
  to.nodes.back().push_back(q);
  piece.curve = to.n_curves - 1;
  piece.edge = common_edge(mesh, p, q);
  piece.a = barycentrics_in(mesh, p, piece.face).value();
  piece.b = barycentrics_in(mesh, q, piece.face).value();
  to.pieces.push_back(piece);
  return true;
}

PlacedSources completed_curves(const SurfaceMesh& mesh, const PlacedSources& sources,
                               const VecX& phi) {
  PlacedSources out = sources;
  if (!any_signed(sources)) return out;
  const Nearby given(mesh, sources);
  for (const Polyline& line : isolines(mesh, phi, 0)) {
    const std::size_t n = line.nodes.size();
    bool goes_on = false;
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < n; ++i) {
      const SurfacePoint p = simplest(mesh, line.nodes[i]);
      const SurfacePoint q = simplest(mesh, line.nodes[(i + 1) % n]);
      const int face = common_face(mesh, p, q);
      const Vec3 middle = 0.5 * (mesh.position(p) + mesh.position(q));
      goes_on =
          face >= 0 && !given.has_beside(face, middle) && append_step(mesh, p, q, goes_on, out);
    }
  }
  return out;
}

CurveSides::CurveSides(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                       const PlacedSources& sources, const VecX& phi)
    : T_(T), phi_(phi), first_(T.n_faces() + 1, 0) {
  for (const CurvePiece& piece : sources.pieces)
    if (piece.is_signed && T.triangle_of_face[piece.face] >= 0)
      for (const TriangleSources::Segment& s : segments_of(mesh, T, piece)) segments_.push_back(s);
  std::stable_sort(segments_.begin(), segments_.end(),
                   [](const auto& s, const auto& t) { return s.triangle < t.triangle; });
  for (const auto& s : segments_) ++first_[s.triangle + 1];
  for (std::size_t f = 1; f < first_.size(); ++f) first_[f] += first_[f - 1];
}

double CurveSides::at(int triangle, const P2Shape<2>::Point& b) const {
  if (segments_.empty()) return 1;
  const Side side = nearest(triangle, b);
  if (side.sign != 0) return side.sign;
  double phi = 0;
  for (int k = 0; k < 3; ++k)
    if (b[k] != 0) phi += b[k] * phi_[T_.faces(triangle, k)];
  return phi < 0 ? -1 : 1;
}

VecX CurveSides::at_vertices() const {
  VecX sign = VecX::Ones(phi_.size());
  if (segments_.empty()) return sign;
  for (Eigen::Index v = 0; v < sign.size(); ++v)
    if (phi_[v] < 0) sign[v] = -1;
  std::map<int, double> least;  // of the vertices beside a signed curve
  for (int f = 0; f < T_.n_faces(); ++f) {
    if (first_[f] == first_[f + 1]) continue;
    for (int k = 0; k < 3; ++k) {
      const int v = T_.faces(f, k);
      const Side side = nearest(f, P2Shape<2>::corner(k));
      const auto known = least.try_emplace(v, infinity).first;
      if (side.distance >= known->second) continue;
      known->second = side.distance;
      sign[v] = side.sign != 0 ? side.sign : phi_[v] < 0 ? -1 : 1;
    }
  }
  return sign;
}

CurveSides::Side CurveSides::nearest(int triangle, const P2Shape<2>::Point& b) const {
  const TriangleShape shape = T_.shape(triangle);
  const auto place = [&shape](const auto& p) {
    return p[0] * shape.p[0] + p[1] * shape.p[1] + p[2] * shape.p[2];
  };
  const Complex x = place(b);
  // The nearest pieces vote, unless the point lies ahead of their ends rather than beside them.
  Side best{infinity, 0};
  bool agree = true;
  for (std::size_t i = first_[triangle]; i < first_[triangle + 1]; ++i) {
    const Complex a = place(segments_[i].a), along = place(segments_[i].b) - a;
    const double length = std::abs(along);
    if (!(length > 0)) continue;
    const double t = std::clamp(((x - a) * std::conj(along)).real() / (length * length), 0.0, 1.0);
    const double distance = std::abs(x - a - t * along);
    if (distance > best.distance * (1 + 1e-9)) continue;
    const double left = ((x - a) * std::conj(along)).imag() / length;
    const double sign = std::abs(left) < 0.5 * distance ? 0 : left > 0 ? 1 : -1;
    if (distance < best.distance * (1 - 1e-9)) best = {distance, sign}, agree = true;
    agree = agree && sign == best.sign;
  }
  if (!agree) best.sign = 0;
  return best;
}

}  // namespace littoral
