#include <cmath>
#include <memory>
#include <vector>

#include "operators/tet_operators.h"

namespace littoral {

namespace {

using Tets = std::shared_ptr<const TetOperators>;

LinearMap gradient(const Tets& T) {
  LinearMap G;
  const Eigen::Index n = T->tets().rows();
  G.rows = 3 * n;
  G.cols = T->L.rows();
  G.apply = [T, n](const VecX& u) {
    VecX g(3 * n);
    for (Eigen::Index t = 0; t < n; ++t) {
      Vec3 sum = Vec3::Zero();
      for (int k = 0; k < 4; ++k) sum += u[T->tets()(t, k)] * T->gradients[t].row(k).transpose();
      g.segment<3>(3 * t) = sum;
    }
    return g;
  };
  G.matrix = [T, n] {
    Triplets entries;
    entries.reserve(12 * n);
    for (Eigen::Index t = 0; t < n; ++t)
      for (int k = 0; k < 4; ++k)
        for (int d = 0; d < 3; ++d)
          entries.emplace_back(3 * t + d, T->tets()(t, k), T->gradients[t](k, d));
    SpRows matrix(3 * n, T->L.rows());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  };
  return G;
}

}  // namespace

Calculus tet_calculus(const Tets& T) {
  Calculus C;
  C.L = T->L;
  C.G = gradient(T);
  C.A = T->volumes;
  C.M = VecX::Zero(T->L.rows());
  C.component = T->component;
  C.n_components = T->n_components;
  C.boundary.assign(C.component.size(), 0);
  std::vector<int> uses(T->n_faces, 0);
  double length = 0;
  for (Eigen::Index t = 0; t < C.A.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      C.M[T->tets()(t, k)] += C.A[t] / 4;
      ++uses[T->tet_faces(t, k)];
      length += std::cbrt(6 * std::sqrt(2.0) * C.A[t]) / 4;  // edge of the regular tet
    }
  for (Eigen::Index t = 0; t < C.A.size(); ++t)
    for (int k = 0; k < 4; ++k)
      if (uses[T->tet_faces(t, k)] == 1)
        for (int j = 0; j < 4; ++j)
          if (j != k) C.boundary[T->tets()(t, j)] = 1;
  C.h = C.A.size() > 0 ? length / static_cast<double>(C.A.size()) : 0;
  return C;
}

}  // namespace littoral
