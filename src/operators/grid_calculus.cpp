#include <array>

#include "base/index.h"
#include "operators/grid.h"

namespace littoral {

namespace {

/// Calls put(axis, node, next) for every grid edge.
template <class Put>
void for_edges(const Grid& grid, const Put& put) {
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const std::array<int, 3> at = {i, j, k};
        const int node = grid.node(i, j, k);
        int step = 1;
        for (int axis = 0; axis < 3; ++axis) {
          if (at[axis] + 1 < grid.n[axis]) put(axis, node, node + step);
          step *= grid.n[axis];
        }
      }
}

SpRows gradient_rows(const Grid& grid) {
  SpRows G(3 * index(grid.n_nodes()), grid.n_nodes());
  G.reserve(Eigen::VectorXi::Constant(G.rows(), 2));
  for_edges(grid, [&](int axis, int node, int next) {
    G.insert(3 * Eigen::Index{node} + axis, node) = -1 / grid.spacing[axis];
    G.insert(3 * Eigen::Index{node} + axis, next) = 1 / grid.spacing[axis];
  });
  G.makeCompressed();
  return G;
}

}  // namespace

Calculus grid_calculus(const Grid& grid) {
  const Eigen::Index n = grid.n_nodes();
  Calculus C;
  C.M = C.A = VecX::Constant(n, grid.spacing.prod());
  C.h = grid.spacing.mean();
  C.component.assign(n, 0);
  C.n_components = 1;
  C.boundary.assign(n, 0);
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        C.boundary[grid.node(i, j, k)] = i == 0 || j == 0 || k == 0 || i == grid.n[0] - 1 ||
                                         j == grid.n[1] - 1 || k == grid.n[2] - 1;
  VecX diagonal = VecX::Zero(n);
  C.L.resize(n, n);
  C.L.reserve(Eigen::VectorXi::Constant(n, 4));
  const auto weight = [&](int axis) {
    return grid.spacing.prod() / (grid.spacing[axis] * grid.spacing[axis]);
  };
  for_edges(grid, [&](int axis, int node, int next) {
    diagonal[node] += weight(axis);
    diagonal[next] += weight(axis);
  });
  for (Eigen::Index i = 0; i < n; ++i) C.L.insert(i, i) = diagonal[i];
  for_edges(grid, [&](int axis, int node, int next) { C.L.insert(next, node) = -weight(axis); });
  C.L.makeCompressed();
  C.G.rows = 3 * n;
  C.G.cols = n;
  C.G.apply = [grid](const VecX& u) {
    VecX g = VecX::Zero(3 * u.size());
    for_edges(grid, [&](int axis, int node, int next) {
      g[3 * Eigen::Index{node} + axis] = (u[next] - u[node]) / grid.spacing[axis];
    });
    return g;
  };
  C.G.adjoint = [grid](const VecX& g) {
    VecX u = VecX::Zero(g.size() / 3);
    for_edges(grid, [&](int axis, int node, int next) {
      const double flow = g[3 * Eigen::Index{node} + axis] / grid.spacing[axis];
      u[node] -= flow;
      u[next] += flow;
    });
    return u;
  };
  C.G.matrix = [grid] { return gradient_rows(grid); };
  return C;
}

double grid_sharpening_memory(double nodes) { return 1800 * nodes; }

}  // namespace littoral
