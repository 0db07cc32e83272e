#include <algorithm>
#include <memory>

#include "base/index.h"
#include "operators/p2.h"

namespace littoral {

namespace {

using Shape = P2Shape<2>;

/// Gradients of the basis functions at the three edge midpoints of a triangle.
std::array<Shape::Slopes, 3> slopes_at_cells(const P2Elements<2>& E, int f) {
  std::array<Shape::Slopes, 3> g;
  for (int k = 0; k < 3; ++k) g[k] = Shape::slopes(Shape::middle(k), E.grad[f]);
  return g;
}

LinearMap gradient_map(std::shared_ptr<const P2Elements<2>> E) {
  LinearMap G;
  G.rows = 6 * index(E->n_elements());
  G.cols = E->n_nodes();
  G.apply = [E](const VecX& u) {
    VecX X(6 * index(E->n_elements()));
    for (int f = 0; f < E->n_elements(); ++f)
      for (int k = 0; k < 3; ++k)
        X.segment<2>(6 * Eigen::Index{f} + 2 * k) = E->gradient(u, f, Shape::middle(k));
    return X;
  };
  G.adjoint = [E](const VecX& X) {
    VecX u = VecX::Zero(E->n_nodes());
    for (int f = 0; f < E->n_elements(); ++f) {
      const auto g = slopes_at_cells(*E, f);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < Shape::nodes; ++i)
          for (int d = 0; d < 2; ++d)
            u[E->node[f][i]] += g[k][d][i] * X[6 * Eigen::Index{f} + 2 * k + d];
    }
    return u;
  };
  G.matrix = [E] {
    Triplets entries;
    entries.reserve(E->node.size() * 36);
    for (int f = 0; f < E->n_elements(); ++f) {
      const auto g = slopes_at_cells(*E, f);
      for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 2; ++d)
          for (int i = 0; i < Shape::nodes; ++i)
            entries.emplace_back(6 * f + 2 * k + d, E->node[f][i], g[k][d][i]);
    }
    SpRows matrix(6 * Eigen::Index{E->n_elements()}, E->n_nodes());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  };
  return G;
}

SpMat stiffness(const P2Elements<2>& E) {
  Triplets entries;
  entries.reserve(E.node.size() * 21);
  for (int f = 0; f < E.n_elements(); ++f) {
    const auto g = slopes_at_cells(E, f);
    for (int i = 0; i < Shape::nodes; ++i)
      for (int j = 0; j < Shape::nodes; ++j) {
        if (E.node[f][i] < E.node[f][j]) continue;
        double sum = 0;
        for (int k = 0; k < 3; ++k)
          for (int d = 0; d < 2; ++d) sum += g[k][d][i] * g[k][d][j];
        entries.emplace_back(E.node[f][i], E.node[f][j], sum * E.measure[f] / 3);
      }
  }
  SpMat L(E.n_nodes(), E.n_nodes());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

}  // namespace

Calculus p2_calculus(const P2Elements<2>& E) {
  Calculus C;
  C.L = stiffness(E);
  C.G = gradient_map(std::make_shared<const P2Elements<2>>(E));
  C.M = VecX::Zero(E.n_nodes());
  C.A.resize(3 * index(E.n_elements()));
  C.h = 0.5 * E.h;
  C.component.assign(E.n_nodes(), -1);
  C.n_components = E.n_components;
  C.boundary.assign(C.component.size(), 0);
  std::vector<int> sides(E.n_edges, 0);
  for (int f = 0; f < E.n_elements(); ++f) {
    const auto& node = E.node[f];
    for (int i = 0; i < Shape::nodes; ++i) {
      C.component[node[i]] = E.component[node[0]];
      C.M[node[i]] += E.measure[f] / (i < 3 ? 12 : 4);
    }
    for (int k = 0; k < 3; ++k) {
      C.A[3 * Eigen::Index{f} + k] = E.measure[f] / 3;
      ++sides[node[3 + k] - E.n_vertices];
    }
  }
  for (const auto& node : E.node)
    for (int k = 0; k < 3; ++k)
      if (sides[node[3 + k] - E.n_vertices] == 1)
        for (int n : {node[3 + k], node[Shape::edge(k)[0]], node[Shape::edge(k)[1]]})
          C.boundary[n] = 1;
  return C;
}

}  // namespace littoral
