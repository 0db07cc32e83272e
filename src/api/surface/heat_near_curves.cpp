#include "api/surface/heat_near_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "api/surface/discretization.h"
#include "api/surface/heat_surface.h"
#include "base/index.h"
#include "methods/heat/time_scale.h"
#include "sources/curves/curve_ends.h"
#include "sources/surface/source_values.h"
#include "sources/surface/surface_points.h"

namespace littoral {

namespace {

// Measured on damaged curves: docs/measurements/robustness.md, near the curves or everywhere.
constexpr double largest_band = 1.0 / 3;  // of the faces: with more, too little time is saved
constexpr double beside_curves = 6;       // decay lengths of heat that a band reaches
constexpr double around_ends = 1.75;      // gaps that it reaches there
constexpr double well_inside = 1;         // of how far the zero set goes: what is left beyond it
constexpr double widest = 64;             // times as wide as at first; largest_band stops it before

/// An end, and how far it is to the nearest end of what is not joined to it; if there is none, to
/// the nearest of its own [length].
struct Gap {
  std::vector<int> faces;  // at the end
  double width;
};

std::vector<Gap> gaps_at(const SurfaceMesh& mesh, const std::vector<OpenEnd>& ends) {
  std::vector<Gap> gaps;
  std::vector<Vec3> place;
  for (const OpenEnd& end : ends) {
    const SurfacePoint p = simplest(mesh, end.at);
    gaps.push_back({faces_at(mesh, p), 0});
    place.push_back(mesh.position(p));
  }
  for (std::size_t i = 0; i < ends.size(); ++i) {
    double to_others = infinity, to_own = infinity;
    for (std::size_t j = 0; j < ends.size(); ++j) {
      double& least = ends[j].chain == ends[i].chain ? to_own : to_others;
      if (j != i) least = std::min(least, (place[j] - place[i]).stableNorm());
    }
    const double least = to_others < infinity ? to_others : to_own;
    if (least < infinity) gaps[i].width = least;
  }
  return gaps;
}

/// The faces of a mesh that have a vertex with finite d, as a mesh.
class Band {
 public:
  Band(const SurfaceMesh& mesh, const VecX& d) : whole_(mesh), face_(mesh.n_faces(), -1) {
    PolygonSoup soup;
    std::vector<int> corners, edge_of_side, local(mesh.n_vertices(), -1);
    for (int f = 0; f < mesh.n_faces(); ++f) {
      const auto face = mesh.face(f);
      if (std::none_of(face.begin(), face.end(), [&](int v) { return d[v] < infinity; })) continue;
      face_[f] = soup.n_faces();
      corners.clear();
      for (int k = 0; k < static_cast<int>(face.size()); ++k) {
        int& number = local[face[k]];
        if (number < 0) {
          number = static_cast<int>(vertices_.size());
          vertices_.push_back(face[k]);
        }
        corners.push_back(number);
        edge_of_side.push_back(mesh.side_edge(f, k));
      }
      soup.add_face(corners);
    }
    soup.points = mesh.points()(vertices_, Eigen::all);
    mesh_ = std::make_shared<const SurfaceMesh>(std::move(soup), edge_of_side);
  }

  const std::shared_ptr<const SurfaceMesh>& mesh() const { return mesh_; }
  const std::vector<int>& vertices() const { return vertices_; }  // of the whole mesh
  bool holds(int face) const { return face_[face] >= 0; }

  /// A point of the whole mesh at which all faces are held.
  SurfacePoint point(const SurfacePoint& p) const {
    const SurfacePoint q = simplest(whole_, p);
    const int f = faces_at(whole_, q).front();
    const std::array<double, 3> b = barycentrics_in(whole_, q, f).value();
    return simplest(*mesh_, SurfacePoint::in_face(face_[f], b[0], b[1], b[2]));
  }

 private:
  const SurfaceMesh& whole_;
  std::vector<int> face_, vertices_;
  std::shared_ptr<const SurfaceMesh> mesh_;
};

/// Are all vertices of the faces of the zero set well inside the band? `left`: how far it reaches
/// beyond them; `d`: how far they are from the curves (vertices).
bool zero_set_inside(const SurfaceMesh& mesh, const Band& band, const VecX& phi, const VecX& left,
                     const VecX& d, double radius) {
  for (const int v : band.vertices()) {
    if (left[v] >= std::max(0.5 * radius, well_inside * d[v])) continue;
    for (const int f : mesh.vertex_faces(v))
      for (const int other : mesh.face(f))
        if (phi[other] < infinity && (phi[other] < 0) != (phi[v] < 0)) return false;
  }
  return true;
}

/// Gives vertices beyond the band the sign that their neighbours have; false if these disagree, so
/// that the zero set leaves the band.
bool carry_signs(const SurfaceMesh& mesh, const Band& band, double far, VecX& phi) {
  std::vector<int> reached = band.vertices();
  for (std::size_t i = 0; i < reached.size(); ++i) {  // grows meanwhile
    const int v = reached[i];
    for (const int f : mesh.vertex_faces(v)) {
      if (band.holds(f)) continue;
      for (const int other : mesh.face(f)) {
        if (phi[other] == infinity) {
          phi[other] = phi[v] < 0 ? -far : far;
          reached.push_back(other);
        } else if ((phi[other] < 0) != (phi[v] < 0)) {
          return false;
        }
      }
    }
  }
  return true;
}

class NearCurves {
 public:
  NearCurves(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, const PlacedSources& sided)
      : mesh_(mesh),
        T_(T),
        along_edges_(T),
        sided_(sided),
        scale_(automatic_time_scale_of_curves(T.n_faces())),
        marked_(sided.nodes.size(), 0) {
    for (const CurvePiece& piece : sided.pieces) marked_[piece.curve] = 1;
  }

  std::optional<VecX> solve(Task task) const {
    const std::vector<OpenEnd> ends = open_ends(sided_, marked_);
    if (ends.size() > most_ends) return {};
    const std::vector<Gap> gaps = gaps_at(mesh_, ends);
    // A decay length is the root of the diffusion time: scale times half an edge squared.
    const double least = beside_curves * 0.5 * T_.mean_edge_length * std::sqrt(scale_);
    for (double wider = 1; wider <= widest; wider *= 2) {
      const double radius = wider * least;
      const std::vector<EdgePaths::Start> from = starts(gaps, wider, radius);
      const VecX d = along_edges_.lengths(from, radius, task);
      const Band band(mesh_, d);
      if (band.mesh()->n_faces() > largest_band * mesh_.n_faces()) return {};
      VecX phi = VecX::Constant(mesh_.n_vertices(), infinity);
      if (!solve_on(band, task.stage(0.5, "near the curves"), phi)) return {};
      if (zero_set_inside(mesh_, band, phi, radius - d.array(), beside(from, radius, task),
                          radius) &&
          carry_signs(mesh_, band, radius * T_.unit, phi))
        return phi;
    }
    return {};
  }

 private:
  /// Distances from the curves as far as a band can reach.
  VecX beside(std::vector<EdgePaths::Start> from, double radius, const Task& task) const {
    double farthest = 0;
    for (EdgePaths::Start& start : from)
      farthest = std::max(farthest, -std::exchange(start.value, 0));
    return along_edges_.lengths(from, radius + farthest, task);
  }
  /// Where a band grows from: values below 0 where it reaches farther than elsewhere.
  std::vector<EdgePaths::Start> starts(const std::vector<Gap>& gaps, double wider,
                                       double radius) const {
    std::vector<EdgePaths::Start> out;
    for (const CurvePiece& piece : sided_.pieces)
      for (const int v : mesh_.face(piece.face)) out.push_back({v, 0});
    for (const auto& nodes : kept_nodes())
      for (const SurfacePoint& p : *nodes)
        for (const int f : faces_at(mesh_, simplest(mesh_, p)))
          for (const int v : mesh_.face(f)) out.push_back({v, 0});
    for (const Gap& gap : gaps)
      for (const int f : gap.faces)
        for (const int v : mesh_.face(f))
          out.push_back({v, std::min(0.0, radius - wider * around_ends * gap.width / T_.unit)});
    return out;
  }
  std::vector<const std::vector<SurfacePoint>*> kept_nodes() const {
    std::vector<const std::vector<SurfacePoint>*> out;
    for (std::size_t c = 0; c < marked_.size(); ++c)
      if (marked_[c]) out.push_back(&sided_.nodes[c]);
    return out;
  }

  /// Signed heat with the diffusion time of the whole mesh; false where it is not long enough.
  bool solve_on(const Band& band, Task task, VecX& phi) const {
    Report quiet;
    const SurfaceDomain near{band.mesh(), {}};
    const auto T = triangulation_of(near, quiet);
    const double ratio = T_.mean_edge_length * T_.unit / (T->mean_edge_length * T->unit);
    SignedHeat options;
    options.time_scale = scale_ * ratio * ratio;
    const auto heat = unchecked_signed_heat(near, T, options, SolveHint::single_rhs,
                                            task.stage(0.6, "factoring"), quiet);
    Sources curves;
    for (const auto& nodes : kept_nodes()) {
      Curve& curve = curves.curves.emplace_back();
      for (const SurfacePoint& p : *nodes) curve.nodes.push_back(band.point(p));
    }
    const VecX values = heat(curves, task.stage(0.4, "solving"), quiet);
    for (std::size_t i = 0; i < band.vertices().size(); ++i)
      phi[band.vertices()[i]] = values[index(i)];
    const double share = double(band.mesh()->n_faces()) / mesh_.n_faces();
    return misaligned_fraction(quiet) * share <= tolerable_share && values.allFinite();
  }

  const SurfaceMesh& mesh_;
  const IntrinsicTriangulation& T_;
  const EdgePaths along_edges_;
  const PlacedSources& sided_;
  double scale_;              // of the diffusion time on the whole mesh
  std::vector<char> marked_;  // curves with pieces
};

}  // namespace

std::optional<VecX> signed_heat_near(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                     const PlacedSources& sided, Task task) {
  return NearCurves(mesh, T, sided).solve(std::move(task));
}

}  // namespace littoral
