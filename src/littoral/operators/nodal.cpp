#include "littoral/operators/nodal.h"

#include <algorithm>
#include <cmath>

#include "littoral/operators/triangles.h"

namespace littoral {

namespace {

/// Numbers the members of one patch: fine vertices or nodes.
class Numbering {
 public:
  explicit Numbering(Eigen::Index n) : local_(static_cast<std::size_t>(n), -1) {}
  Eigen::Index operator()(int item) {
    if (local_[item] < 0) {
      local_[item] = static_cast<int>(items.size());
      items.push_back(item);
    }
    return local_[item];
  }
  void clear() {
    for (int item : items) local_[item] = -1;
    items.clear();
  }
  std::vector<int> items;

 private:
  std::vector<int> local_;
};

Complex unit_or_one(Complex z) { return std::abs(z) > 0 ? z / std::abs(z) : Complex(1); }

/// The real axis of a cell's frame in the frame of its patch, by projecting the longest side.
Complex cell_axis(const NodalSurface& S, int c, const TangentFrame& frame) {
  const IntrinsicTriangulation& T = *S.cells;
  int k = 0;
  for (int l = 1; l < 3; ++l)
    if (T.length(c, l) > T.length(c, k)) k = l;
  const Vec3 side =
      S.refined->point(T.faces(c, (k + 1) % 3)) / T.unit - S.refined->point(T.faces(c, k)) / T.unit;
  return unit_or_one(frame.coordinates(side)) * std::conj(T.shape(c).side[k]);
}

/// The stiffness of a patch and the connection on it.
class Assembly {
 public:
  explicit Assembly(const NodalSurface& S) : S_(S), fine_(S.P.rows()), node_(S.P.cols()) {}

  void add_patch(int p) {
    const IntrinsicTriangulation& T = *S_.cells;
    fine_.clear();
    node_.clear();
    for (int c = S_.patch_offsets[p]; c < S_.patch_offsets[p + 1]; ++c)
      for (int k = 0; k < 3; ++k) fine_(T.faces(c, k));
    for (int v : fine_.items)
      for (Interpolation::InnerIterator it(S_.P, v); it; ++it) node_(static_cast<int>(it.col()));
    const auto m = static_cast<Eigen::Index>(fine_.items.size()),
               n = static_cast<Eigen::Index>(node_.items.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(m, m), P = Eigen::MatrixXd::Zero(m, n);
    for (Eigen::Index v = 0; v < m; ++v)
      for (Interpolation::InnerIterator it(S_.P, fine_.items[v]); it; ++it)
        P(v, node_(static_cast<int>(it.col()))) = it.value();
    const TangentFrame frame(S_.patch_normals.row(p));
    VecXc turn(n);
    for (Eigen::Index i = 0; i < n; ++i)
      turn[i] = TangentFrame(S_.normals.row(node_.items[i])).turn_into(frame);

    for (int c = S_.patch_offsets[p]; c < S_.patch_offsets[p + 1]; ++c) {
      const auto cot = T.shape(c).cot;
      VecX mean = VecX::Zero(n);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Index i = fine_(T.faces(c, k)), j = fine_(T.faces(c, (k + 1) % 3));
        const double w = 0.5 * S_.weight[c] * cot[(k + 2) % 3];
        K(i, i) += w;
        K(j, j) += w;
        K(i, j) -= w;
        K(j, i) -= w;
        mean += P.row(i).transpose() / 3;
      }
      const Complex axis = std::conj(cell_axis(S_, c, frame));
      for (Eigen::Index i = 0; i < n; ++i)
        if (mean[i] != 0) to_cells.emplace_back(c, node_.items[i], mean[i] * axis * turn[i]);
    }
    const Eigen::MatrixXd L_p = P.transpose() * K * P;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const int row = node_.items[i], col = node_.items[j];
        if (row < col) continue;
        L.emplace_back(row, col, L_p(i, j));
        connection.emplace_back(
            row, col, row == col ? Complex(L_p(i, i)) : L_p(i, j) * std::conj(turn[i]) * turn[j]);
      }
  }

  Triplets L;
  std::vector<Eigen::Triplet<Complex>> connection, to_cells;

 private:
  using Interpolation = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  const NodalSurface& S_;
  Numbering fine_, node_;
};

/// A complex matrix on interleaved pairs.
LinearMap as_linear_map(std::shared_ptr<const Eigen::SparseMatrix<Complex, Eigen::RowMajor>> Q) {
  using Pairs = Eigen::Map<const VecXc>;
  auto pairs = [](const VecX& x) {
    return Pairs(reinterpret_cast<const Complex*>(x.data()), x.size() / 2);
  };
  auto reals = [](const VecXc& z) {
    return VecX(Eigen::Map<const VecX>(reinterpret_cast<const double*>(z.data()), 2 * z.size()));
  };
  return {2 * Q->rows(),
          2 * Q->cols(),
          [=](const VecX& x) { return reals(VecXc(*Q * pairs(x))); },
          [=](const VecX& y) { return reals(VecXc(Q->adjoint() * pairs(y))); },
          {}};
}

/// Masses of the cells at their corners, shared among the nodes that determine those: positive, and
/// the same in sum, also where weights are negative.
VecX node_masses(const NodalSurface& S, const VecX& A) {
  VecX M_fine = VecX::Zero(S.P.rows()), M = VecX::Zero(S.n_nodes());
  for (Eigen::Index c = 0; c < A.size(); ++c)
    for (int k = 0; k < 3; ++k) M_fine[S.cells->faces(c, k)] += A[c] / 3;
  for (Eigen::Index v = 0; v < S.P.rows(); ++v) {
    double sum = 0;
    using Row = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;
    for (Row it(S.P, v); it; ++it) sum += std::abs(it.value());
    for (Row it(S.P, v); it; ++it) M[it.col()] += M_fine[v] * std::abs(it.value()) / sum;
  }
  return M;
}

}  // namespace

Complex TangentFrame::turn_into(const TangentFrame& other) const {
  return unit_or_one(other.coordinates(turned(x, n, other.n)));
}

Operators nodal_operators(const NodalSurface& S) {
  const int n = S.n_nodes();
  const Calculus fine = triangle_calculus(S.cells);
  Assembly assembly(S);
  for (int p = 0; p < S.n_patches(); ++p) assembly.add_patch(p);

  Operators ops;
  ops.domain = S.domain;
  ops.unit = S.place->unit;
  Calculus& C = ops.scalar;
  C.L.resize(n, n);
  C.L.setFromTriplets(assembly.L.begin(), assembly.L.end());
  C.A = fine.A.cwiseProduct(S.weight);
  C.M = node_masses(S, C.A);
  const auto P = std::make_shared<const SpMat>(S.P);
  C.G = {fine.G.rows, n, [P, G = fine.G](const VecX& u) { return G.apply(*P * u); },
         [P, G = fine.G](const VecX& g) { return VecX(P->transpose() * G.adjoint(g)); },
         [P, G = fine.G] { return SpRows(G.matrix() * SpRows(*P)); }};
  C.h = S.spacing;
  C.component.assign(S.place->component.begin(), S.place->component.begin() + n);
  C.n_components = S.place->n_components;
  C.boundary.assign(static_cast<std::size_t>(n), 0);
  for (int e = 0; e < S.place->n_edges(); ++e)
    if (S.place->edge_use[e] == 1)
      for (int k = 0; k < 2; ++k)
        if (S.place->edges(e, k) < n) C.boundary[S.place->edges(e, k)] = 1;

  VectorDiffusion& V = ops.vector;
  V.n = n;
  V.at_nodes = true;
  V.M = C.M;
  V.L.resize(n, n);
  V.L.setFromTriplets(assembly.connection.begin(), assembly.connection.end());
  auto Q = std::make_shared<Eigen::SparseMatrix<Complex, Eigen::RowMajor>>(fine.A.size(), n);
  Q->setFromTriplets(assembly.to_cells.begin(), assembly.to_cells.end());
  V.to_cells = as_linear_map(Q);
  V.h = S.spacing;
  V.piece = C.component;
  V.n_pieces = C.n_components;
  return ops;
}

}  // namespace littoral
