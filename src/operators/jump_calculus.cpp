#include "operators/jump_calculus.h"

#include <algorithm>
#include <map>
#include <string>

#include "base/disjoint_sets.h"
#include "littoral/error.h"

namespace littoral {

namespace {

void glue(const IntrinsicTriangulation& T, JumpCalculus& J) {
  std::vector<int> count(J.n_edges, 0);
  J.sides.assign(J.n_edges, {});
  J.manifold.assign(J.n_edges, 1);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int e = J.edge(f, k);
      if (count[e] < 2) J.sides[e][count[e]] = {f, k};
      ++count[e];
    }
  const auto left = [&](const JumpCalculus::Side& s) {
    return T.orientation[s.face] * T.along(s.face, s.k) > 0;
  };
  for (int e = 0; e < J.n_edges; ++e) {
    auto& sides = J.sides[e];
    if (count[e] > 2) {
      sides = {};
      J.manifold[e] = 0;
    } else if (count[e] > 0 && !left(sides[0])) {  // where the two disagree the first decides
      std::swap(sides[0], sides[1]);
    }
  }
}

void find_nodes(JumpCalculus& J) {
  DisjointSets corners(3 * J.n_faces), faces(J.n_faces);
  for (int e = 0; e < J.n_edges; ++e) {
    if (!J.interior(e)) continue;
    const auto [a, b] = J.sides[e];
    const auto at_a = J.ends(a), at_b = J.ends(b);
    for (int end = 0; end < 2; ++end) corners.join(3 * a.face + at_a[end], 3 * b.face + at_b[end]);
    faces.join(a.face, b.face);
  }
  const std::vector<int> node = corners.numbered(J.n_nodes);
  J.node = Eigen::Map<const MatX3i>(node.data(), J.n_faces, 3);
  J.component = faces.numbered(J.n_components);
}

/// A component without holes or handles: a sphere or a disk, by its Euler characteristic.
void find_topology(const IntrinsicTriangulation& T, JumpCalculus& J) {
  std::vector<int> euler(J.n_components, 0), boundary(J.n_components, 0);
  std::vector<int> node_component(J.n_nodes, -1);
  J.orientable.assign(J.n_components, 1);
  for (int f = 0; f < J.n_faces; ++f) {
    ++euler[J.component[f]];
    for (int k = 0; k < 3; ++k) node_component[J.node(f, k)] = J.component[f];
    // Sides without a partner count as edges of their own, also where three faces meet.
    for (int k = 0; k < 3; ++k)
      if (!J.interior(J.edge(f, k))) {
        --euler[J.component[f]];
        ++boundary[J.component[f]];
      }
  }
  for (int e = 0; e < J.n_edges; ++e) {
    if (!J.interior(e)) continue;
    const auto [a, b] = J.sides[e];
    --euler[J.component[a.face]];
    if (T.orientation[a.face] * T.along(a.face, a.k) ==
        T.orientation[b.face] * T.along(b.face, b.k))
      J.orientable[J.component[a.face]] = 0;
  }
  for (int c : node_component) ++euler[c];
  J.simply_connected.resize(J.n_components);
  for (int c = 0; c < J.n_components; ++c)
    J.simply_connected[c] = euler[c] == (boundary[c] > 0 ? 1 : 2);
}

}  // namespace

JumpCalculus::Side JumpCalculus::across(int f, int k) const {
  const auto& [a, b] = sides[edge(f, k)];
  return a.face == f && a.k == k ? b : b.face == f && b.k == k ? a : Side{};
}

int JumpCalculus::corner_across(int f, int corner, const Side& at) const {
  const int v = node(f, corner);
  return node(at.face, at.k) == v ? at.k : (at.k + 1) % 3;
}

std::array<int, 2> JumpCalculus::ends(const Side& s) const {
  const int next = (s.k + 1) % 3;
  if (along(s.face, s.k) > 0) return {s.k, next};
  return {next, s.k};
}

VecX JumpCalculus::d1(const VecX& omega) const {
  VecX sum = VecX::Zero(n_faces);
  for (int f = 0; f < n_faces; ++f)
    for (int k = 0; k < 3; ++k) sum[f] += along(f, k) * omega[edge(f, k)];
  return sum;
}

VecX JumpCalculus::d1_transpose(const VecX& beta) const {
  VecX omega = VecX::Zero(n_edges);
  for (int f = 0; f < n_faces; ++f)
    for (int k = 0; k < 3; ++k) omega[edge(f, k)] += along(f, k) * beta[f];
  return omega;
}

JumpCalculus jump_calculus(const IntrinsicTriangulation& T) {
  JumpCalculus J;
  J.n_faces = T.n_faces();
  J.n_edges = T.n_edges();
  J.edge = T.side_edge.matrix();
  J.along = T.along;
  glue(T, J);
  find_nodes(J);
  find_topology(T, J);
  J.weight.resize(J.n_faces, 3);
  J.area.resize(J.n_faces);
  J.side.resize(J.n_faces);
  J.length = J.star1 = VecX::Zero(J.n_edges);
  for (int f = 0; f < J.n_faces; ++f) {
    const TriangleShape t = T.shape(f);
    J.area[f] = t.area;
    for (int k = 0; k < 3; ++k) {
      J.side[f][k] = t.p[(k + 1) % 3] - t.p[k];
      J.weight(f, k) = 0.5 * t.cot[(k + 2) % 3];
      J.length[J.edge(f, k)] = T.length(f, k);
      J.star1[J.edge(f, k)] += J.weight(f, k);
    }
  }
  // Any positive star decomposes forms; where the cotangents' is not, it is made so.
  J.star1 = J.star1.cwiseMax(1e-3).cwiseMin(1e3);
  return J;
}

std::vector<FacePair> pairs_at_nonmanifold_edges(const JumpCalculus& J) {
  constexpr std::size_t most = 64;
  std::map<int, std::vector<JumpCalculus::Side>> around;
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      if (!J.manifold[J.edge(f, k)]) around[J.edge(f, k)].push_back({f, k});
  std::vector<FacePair> pairs;
  for (const auto& [e, sides] : around) {
    if (sides.size() > most)
      throw UnsupportedError(std::to_string(sides.size()) + " faces, the first of them " +
                             std::to_string(sides[0].face) + ", meet at one edge; at most " +
                             std::to_string(most) + " may where winding numbers are wanted");
    for (std::size_t i = 0; i < sides.size(); ++i)
      for (std::size_t j = i + 1; j < sides.size(); ++j) {
        const auto [f, k] = sides[i];
        const auto [g, l] = sides[j];
        const double star1 = std::clamp(J.weight(f, k) + J.weight(g, l), 1e-3, 1e3);
        pairs.push_back({f, g, e, 0, star1});
      }
  }
  return pairs;
}

}  // namespace littoral
