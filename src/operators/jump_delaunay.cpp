#include "operators/jump_delaunay.h"

#include <utility>

#include "domain/intrinsic/intrinsic_delaunay.h"

namespace littoral {

namespace {

/// Vertices where several fans touch: no vertex alone says which of them a corner belongs to.
std::vector<char> touched_by_several(const IntrinsicTriangulation& T, const JumpCalculus& J) {
  std::vector<int> node(T.n_vertices, -1);
  std::vector<char> several(T.n_vertices, 0);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      int& first = node[T.faces(f, k)];
      if (first < 0) first = J.node(f, k);
      if (first != J.node(f, k)) several[T.faces(f, k)] = 1;
    }
  return several;
}

/// The curve, and all triangles at such vertices, stay as they are.
std::vector<char> kept_edges(const IntrinsicTriangulation& T, const VecX& curve,
                             const std::vector<char>& several) {
  std::vector<char> keep(T.n_edges(), 0);
  for (int e = 0; e < T.n_edges(); ++e) keep[e] = curve[e] != 0;
  for (int f = 0; f < T.n_faces(); ++f)
    if (several[T.faces(f, 0)] || several[T.faces(f, 1)] || several[T.faces(f, 2)])
      for (int k = 0; k < 3; ++k) keep[T.side_edge(f, k)] = 1;
  return keep;
}

/// The edges of the curve as something drawn on the surface, which says where they are afterwards.
CurveNetwork drawn(const IntrinsicTriangulation& T, const VecX& curve) {
  CurveNetwork network;
  for (int v = 0; v < T.n_vertices; ++v) network.nodes.push_back(SurfacePoint::at_vertex(v));
  for (int e = 0; e < T.n_edges(); ++e)
    if (curve[e] != 0) network.segments.push_back({e, 0, 1, T.edges(e, 0), T.edges(e, 1), -1, e});
  return network;
}

}  // namespace

VecX DelaunayJumps::jump(const VecX& before_flips) const {
  VecX out = VecX::Zero(J->n_edges);
  for (Eigen::Index e = 0; e < before_flips.size(); ++e)
    if (edge[e] >= 0) out[edge[e]] = along[e] * before_flips[e];
  return out;
}

DelaunayJumps delaunay_jumps(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                             const JumpCalculus& J, const VecX& curve, const Task& task,
                             Report& report) {
  const std::vector<char> several = touched_by_several(T, J);
  RefineOptions flips;
  flips.smallest_angle = 0;
  flips.keep = kept_edges(T, curve, several);
  const Retriangulation fine = intrinsic_delaunay(mesh, T, drawn(T, curve), flips, report, task);
  DelaunayJumps out;
  out.J = std::make_shared<const JumpCalculus>(jump_calculus(fine.T));
  out.edge.assign(J.n_edges, -1);
  out.along.assign(J.n_edges, 1);
  out.before.resize(J.n_nodes);
  out.here.resize(J.n_nodes);
  for (const CurveNetwork::Segment& s : fine.curves.segments) {
    out.edge[s.id] = s.edge;
    const bool turned = fine.T.edges(s.edge, 0) != T.edges(s.id, 0);
    out.along[s.id] = turned != s.mirrored ? -1 : 1;
  }
  // Triangles at a vertex of several fans are the same as before; their corners run with the
  // orientation now.
  const auto set = [&](int node, DelaunayJumps::Corner a, DelaunayJumps::Corner b) {
    if (out.before[node].face >= 0) return;
    out.before[node] = a;
    out.here[node] = b;
  };
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      if (several[T.faces(f, k)])
        set(J.node(f, k), {f, k}, {f, T.orientation[f] < 0 ? (3 - k) % 3 : k});
  // Elsewhere the left of an edge of the curve is the left of it, at both ends.
  for (int e = 0; e < J.n_edges; ++e) {
    if (out.edge[e] < 0 || !J.interior(e)) continue;
    const JumpCalculus::Side& left = J.sides[e][0];
    const JumpCalculus::Side& same = out.J->sides[out.edge[e]][out.along[e] > 0 ? 0 : 1];
    for (const int k : J.ends(left))
      for (const int l : out.J->ends(same))
        if (T.faces(left.face, k) == fine.T.faces(same.face, l))
          set(J.node(left.face, k), {left.face, k}, {same.face, l});
  }
  // Where no curve is, any corner will do.
  std::vector<DelaunayJumps::Corner> at(T.n_vertices);
  for (int f = 0; f < fine.T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) at[fine.T.faces(f, k)] = {f, k};
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) set(J.node(f, k), {f, k}, at[T.faces(f, k)]);
  return out;
}

}  // namespace littoral
