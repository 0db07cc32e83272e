#include "operators/nodal.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "operators/nodal_cells.h"

namespace littoral {

namespace {

/// Numbers the members of one patch, fine vertices or nodes, in ascending order.
class Numbering {
 public:
  explicit Numbering(Eigen::Index n) : local_(n, -1) {}
  void clear() { items.clear(); }
  void add(int item) { items.push_back(item); }
  void number() {
    std::sort(items.begin(), items.end());
    items.erase(std::unique(items.begin(), items.end()), items.end());
    for (std::size_t i = 0; i < items.size(); ++i) local_[items[i]] = i;
  }
  Eigen::Index operator()(int item) const { return local_[item]; }
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

/// The stiffness of the patches and the connection on them.
class Assembly {
 public:
  explicit Assembly(const NodalSurface& S)
      : cells(std::make_shared<NodalCells>(S)), S_(S), fine_(S.P.rows()), node_(S.P.cols()) {
    L.reserve(std::size_t(S.cells->n_faces()) * 3);
    connection.reserve(std::size_t(S.cells->n_faces()) * 3);
  }

  void add_patch(int p) {
    const IntrinsicTriangulation& T = *S_.cells;
    const int first = S_.patch_offsets[p], last = S_.patch_offsets[p + 1];
    fine_.clear();
    node_.clear();
    for (int c = first; c < last; ++c)
      for (int k = 0; k < 3; ++k) fine_.add(T.faces(c, k));
    fine_.number();
    for (int v : fine_.items)
      for (Interpolation::InnerIterator it(S_.P, v); it; ++it) node_.add(it.col());
    node_.number();
    const Eigen::Index m = fine_.items.size(), n = index(node_.items.size());
    K_.setZero(m, m);
    P_.setZero(m, n);
    for (Eigen::Index v = 0; v < m; ++v)
      for (Interpolation::InnerIterator it(S_.P, fine_.items[v]); it; ++it)
        P_(v, node_(it.col())) = it.value();
    const TangentFrame frame(S_.patch_normals.row(p));
    turn_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i)
      turn_[i] = TangentFrame(S_.normals.row(node_.items[i])).turn_into(frame);
    axes_.resize(last - first);
    for (int c = first; c < last; ++c) {
      axes_[c - first] = cell_axis(S_, c, frame);
      const auto cot = T.shape(c).cot;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Index i = fine_(T.faces(c, k)), j = fine_(T.faces(c, (k + 1) % 3));
        const double w = 0.5 * S_.weight[c] * cot[(k + 2) % 3];
        K_(i, i) += w;
        K_(j, j) += w;
        K_(i, j) -= w;
        K_(j, i) -= w;
      }
    }
    cells->add_patch(node_.items, turn_, axes_);
    KP_.noalias() = K_.lazyProduct(P_);
    L_p_.noalias() = P_.transpose().lazyProduct(KP_);
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = j; i < n; ++i) {
        const int row = node_.items[i], col = node_.items[j];
        L.emplace_back(row, col, L_p_(i, j));
        connection.emplace_back(
            row, col,
            row == col ? Complex(L_p_(i, i)) : L_p_(i, j) * std::conj(turn_[i]) * turn_[j]);
      }
  }

  Triplets L;
  std::vector<Eigen::Triplet<Complex>> connection;
  std::shared_ptr<NodalCells> cells;

 private:
  using Interpolation = NodalCells::Interpolation;
  const NodalSurface& S_;
  Numbering fine_, node_;
  Eigen::MatrixXd K_, P_, KP_, L_p_;  // kept for the next patch
  VecXc turn_, axes_;
};

/// A matrix from its entries, which are given up.
template <class Scalar>
Eigen::SparseMatrix<Scalar> matrix_of(int n, std::vector<Eigen::Triplet<Scalar>>& entries) {
  Eigen::SparseMatrix<Scalar> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  std::vector<Eigen::Triplet<Scalar>>().swap(entries);
  return A;
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
  Assembly assembly(S);
  for (int p = 0; p < S.n_patches(); ++p) assembly.add_patch(p);

  Operators ops;
  ops.domain = S.domain;
  ops.unit = S.place->unit;
  Calculus& C = ops.scalar;
  C.L = matrix_of(n, assembly.L);
  C.A.resize(S.cells->n_faces());
  for (int c = 0; c < S.cells->n_faces(); ++c) {
    const auto l = S.cells->length.row(c);
    C.A[c] = S.weight[c] * area_of_lengths(l[0], l[1], l[2]);
  }
  C.M = node_masses(S, C.A);
  C.G = NodalCells::gradient(assembly.cells);
  C.h = S.spacing;
  C.component.assign(S.place->component.begin(), S.place->component.begin() + n);
  C.n_components = S.place->n_components;
  C.boundary.assign(n, 0);
  for (int e = 0; e < S.place->n_edges(); ++e)
    if (S.place->edge_use[e] == 1)
      for (int k = 0; k < 2; ++k)
        if (S.place->edges(e, k) < n) C.boundary[S.place->edges(e, k)] = 1;

  VectorDiffusion& V = ops.vector;
  V.n = n;
  V.at_nodes = true;
  V.M = C.M;
  const auto L = std::make_shared<const SpMatC>(matrix_of(n, assembly.connection));
  V.L = [L](const Task&) { return *L; };
  V.to_cells = NodalCells::mean(assembly.cells);
  V.h = S.spacing;
  V.piece = C.component;
  V.n_pieces = C.n_components;
  return ops;
}

}  // namespace littoral
