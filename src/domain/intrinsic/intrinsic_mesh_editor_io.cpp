// An IntrinsicMeshEditor from a mesh, and back.

#include <algorithm>
#include <tuple>

#include "base/fetch_ahead.h"
#include "domain/intrinsic/intrinsic_mesh_editor.h"

namespace littoral {

namespace {
constexpr int faces_ahead = 8;  // whose edges lie anywhere
}  // namespace

IntrinsicMeshEditor::IntrinsicMeshEditor(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                         CurveNetwork curves) {
  points_.reserve(std::size_t(mesh.n_vertices()));
  for (int v = 0; v < mesh.n_vertices(); ++v) points_.push_back(mesh.point(v));
  edges.reserve(std::size_t(T.n_edges()));
  faces.reserve(std::size_t(T.n_faces()));
  for (int e = 0; e < T.n_edges(); ++e) edges.push_back({T.edges(e, 0), T.edges(e, 1), 0, {}});
  for (int f = 0; f < T.n_faces(); ++f) {
    if (f + faces_ahead < T.n_faces())
      for (int k = 0; k < 3; ++k) fetch_ahead(&edges[T.side_edge(f + faces_ahead, k)]);
    Face face;
    const bool reversed = T.orientation[f] < 0;
    for (int k = 0; k < 3; ++k) {
      const int from = reversed ? (3 - k) % 3 : k, side = reversed ? 2 - k : k;
      face.v[k] = T.faces(f, from);
      face.e[k] = T.side_edge(f, side);
      const int left = T.orientation[f] * T.along(f, side);
      face.side_sign[k] = T.seam(f, side) ? -left : left;
      Edge& edge = edges[face.e[k]];
      edge.faces.push_back(f);
      edge.length = std::max(edge.length, T.length(f, side));
    }
    faces.push_back(face);
  }
  // Faces without area had their own sides lengthened; now that faces share lengths, all edges are.
  double lift = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i + faces_ahead < faces.size())
      for (const int e : faces[i + faces_ahead].e) fetch_ahead(&edges[e].length);
    const Face& f = faces[i];
    const double a = edges[f.e[0]].length, b = edges[f.e[1]].length, c = edges[f.e[2]].length;
    lift = std::max(
        lift, 2 * collinear_margin * std::max({a, b, c}) - (a + b + c - 2 * std::max({a, b, c})));
  }
  if (lift > 0)
    for (Edge& e : edges) e.length += lift;

  nodes_ = std::move(curves.nodes);
  if (nodes_.empty()) return;
  nodes_in_face_.resize(faces.size());
  in_face_.resize(faces.size());
  nodes_on_edge_.resize(edges.size());
  on_edge_.resize(edges.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    SurfacePoint& p = nodes_[i];
    if (p.on == SurfacePoint::On::edge) nodes_on_edge_[p.element].push_back(i);
    if (p.on != SurfacePoint::On::face) continue;
    if (T.orientation[p.element] < 0) std::swap(p.b[1], p.b[2]);
    nodes_in_face_[p.element].push_back(i);
  }
  for (const CurveNetwork::Segment& s : curves.segments) add_segment(s);
}

Retriangulation IntrinsicMeshEditor::finish(const IntrinsicTriangulation& before) && {
  PolygonSoup soup;
  soup.points.resize(n_vertices(), 3);
  for (int v = 0; v < n_vertices(); ++v) soup.points.row(v) = points_[v];
  std::vector<int> edge_of_side;
  soup.corners.reserve(3 * faces.size());
  soup.face_offsets.reserve(faces.size() + 1);
  edge_of_side.reserve(3 * faces.size());
  for (const Face& f : faces) {
    soup.add_face(f.v);
    edge_of_side.insert(edge_of_side.end(), f.e.begin(), f.e.end());
  }
  Retriangulation out{SurfaceMesh(std::move(soup), edge_of_side), {}, {}, 0, 0, 0};
  IntrinsicTriangulation& T = out.T;
  T.unit = before.unit;
  T.n_vertices = n_vertices();
  T.edges = out.mesh.shared_edges();
  T.faces = out.mesh.shared_faces();
  T.side_edge = out.mesh.shared_side_edges();
  const Eigen::Index n = faces.size();
  T.along.resize(n, 3);
  T.length.resize(n, 3);
  T.orientation.assign(faces.size(), 1);
  T.edge_use.assign(T.n_edges(), 0);
  struct Renewed {
    int number = -1, first_side_sign = 0, first_left = 0;
    bool mirrored = false;
  };
  std::vector<Renewed> renewed(edges.size());
  T.triangle_of_face = FaceTriangles(T.n_faces());
  for (int f = 0; f < T.n_faces(); ++f) {
    if (f + faces_ahead < T.n_faces())
      for (int k = 0; k < 3; ++k) {
        const int e = faces[f + faces_ahead].e[k], E = out.mesh.side_edge(f + faces_ahead, k);
        fetch_ahead(&edges[e]);
        fetch_ahead(&renewed[e]);
        fetch_ahead(&T.edge_use[E]);
        fetch_ahead(T.edges.row(E).data());
      }
    for (int k = 0; k < 3; ++k) {
      const int e = faces[f].e[k], E = out.mesh.side_edge(f, k);
      Renewed& edge = renewed[e];
      edge.number = E;
      T.along(f, k) = out.mesh.side_along(f, k) ? 1 : -1;
      T.length(f, k) = edges[e].length;
      T.edge_use[E] = static_cast<std::uint8_t>(std::min(255, T.edge_use[E] + 1));
      // Faces on the side of the first one lie to the left or right of the edge as that one does.
      if (edge.first_side_sign == 0) {
        edge.first_side_sign = faces[f].side_sign[k];
        edge.first_left = T.along(f, k);
        const int left = T.edges(E, 0) == edges[e].tail ? T.along(f, k) : -T.along(f, k);
        edge.mirrored = left != faces[f].side_sign[k];
      } else if (T.along(f, k) != (faces[f].side_sign[k] == edge.first_side_sign
                                       ? edge.first_left
                                       : -edge.first_left)) {
        if (!T.has_seams()) T.seams = Rows<std::uint8_t, 3>::Zero(n, 3);
        T.seams(f, k) = 1;
      }
    }
  }
  double sum = 0;
  int used = 0;
  for (const Edge& e : edges)
    if (!e.faces.empty()) sum += e.length, ++used;
  T.mean_edge_length = sum / used;
  T.component = out.mesh.vertex_component();
  T.n_components = out.mesh.n_components();

  for (SurfacePoint& p : nodes_) {
    if (p.on != SurfacePoint::On::edge) continue;
    const int number = renewed[p.element].number;
    const bool same = T.edges(number, 0) == edges[p.element].tail;
    p = SurfacePoint::on_edge(number, same ? p.b[1] : p.b[0]);
  }
  for (auto* lists : {&in_face_, &on_edge_})
    for (auto& list : *lists)
      for (CurveNetwork::Segment& s : list) {
        if (s.edge >= 0) {
          s.mirrored = renewed[s.edge].mirrored;
          s.edge = renewed[s.edge].number;
        }
        out.curves.segments.push_back(s);
      }
  std::sort(
      out.curves.segments.begin(), out.curves.segments.end(),
      [](const auto& a, const auto& b) { return std::tie(a.id, a.from) < std::tie(b.id, b.from); });
  out.curves.nodes = std::move(nodes_);
  return out;
}

}  // namespace littoral
