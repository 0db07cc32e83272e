#include "operators/p2_tets.h"

#include <algorithm>
#include <cstdint>

namespace littoral {

P2Tets p2_elements(const TetMesh& mesh, const TetOperators& ops) {
  using Shape = P2Shape<3>;
  P2Tets out;
  P2Elements<3>& E = out.elements;
  E.n_vertices = mesh.n_vertices();
  E.component = ops.component;
  E.n_components = ops.n_components;
  out.element_of_tet.assign(mesh.n_tets(), -1);
  const auto key = [&mesh](int t, int k) {  // of an edge: its ends, the smaller first
    const auto [i, j] = Shape::edge(k);
    const auto ends = std::minmax(mesh.tets(t, i), mesh.tets(t, j));
    return (static_cast<std::uint64_t>(ends.first) << 32) | static_cast<std::uint64_t>(ends.second);
  };
  std::vector<std::uint64_t> edges;
  std::vector<double> measure;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    if (!(ops.volumes[t] > 0)) continue;
    out.element_of_tet[t] = measure.size();
    measure.push_back(ops.volumes[t]);
    E.grad.emplace_back(ops.gradients[t].transpose());
    for (int k = 0; k < Shape::edges; ++k) edges.push_back(key(t, k));
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  E.n_edges = edges.size();
  E.measure = Eigen::Map<const VecX>(measure.data(), measure.size());
  VecX length(E.n_edges), sum = VecX::Zero(E.n_components), count = sum;
  for (int e = 0; e < E.n_edges; ++e) {
    const Eigen::Index a = edges[e] >> 32;
    const Eigen::Index b = edges[e] & 0xffffffffU;
    length[e] = (mesh.points.row(a) - mesh.points.row(b)).norm();
    sum[E.component[a]] += length[e];
    ++count[E.component[a]];
  }
  E.h = E.n_edges > 0 ? length.mean() : 0;
  E.component_h = sum.cwiseQuotient(count.cwiseMax(1.0));
  for (int t = 0; t < mesh.n_tets(); ++t) {
    if (out.element_of_tet[t] < 0) continue;
    std::array<int, Shape::nodes> node{};
    Shape::Sides side;
    for (int i = 0; i < Shape::corners; ++i) node[i] = mesh.tets(t, i);
    for (int k = 0; k < Shape::edges; ++k) {
      const auto at = std::lower_bound(edges.begin(), edges.end(), key(t, k)) - edges.begin();
      node[Shape::corners + k] = E.n_vertices + at;
      side[k] = length[at];
    }
    E.side.push_back(side);
    E.node.push_back(node);
  }
  return out;
}

}  // namespace littoral
