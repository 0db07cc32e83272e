#include "littoral/operators.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/front/running.h"
#include "api/surface/discretization.h"
#include "base/disjoint_sets.h"
#include "littoral/error.h"
#include "solve/direct/cholesky.h"

namespace littoral {

namespace {

/// A Hermitian matrix from its lower triangle.
template <class Scalar>
Eigen::SparseMatrix<Scalar> whole(const Eigen::SparseMatrix<Scalar>& lower) {
  Eigen::SparseMatrix<Scalar> out = lower.template selfadjointView<Eigen::Lower>();
  return out;
}

/// The two directions in space that a triangle's complex frame stands for: real axis along side 0,
/// imaginary axis to its left as the triangle is oriented.
Eigen::Matrix<double, 3, 2> frame_in_space(const MatX3& points, const IntrinsicTriangulation& T,
                                           int t) {
  const Vec3 a = points.row(T.faces(t, 0)), b = points.row(T.faces(t, 1)),
             c = points.row(T.faces(t, 2));
  Eigen::Matrix<double, 3, 2> frame;
  frame.col(0) = (b - a).normalized();
  const Vec3 normal = frame.col(0).cross(c - a).normalized();
  frame.col(1) = double(T.orientation[t]) * normal.cross(frame.col(0));
  return frame;
}

/// Gradients in space of functions on a triangle mesh; faces without a triangle have none.
SpMat gradient_in_space(const Mesh& mesh, const IntrinsicTriangulation& T, const SpRows& G) {
  Triplets entries;
  entries.reserve(std::size_t(9 * T.n_faces()));
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const int t = T.triangle_of_face[f];
    if (t < 0) continue;
    const auto frame = frame_in_space(mesh.points(), T, t);
    if (!frame.allFinite()) continue;  // a face without a plane
    for (int axis = 0; axis < 2; ++axis)
      for (SpRows::InnerIterator g(G, 2 * t + axis); g; ++g)
        for (int row = 0; row < 3; ++row)
          entries.emplace_back(3 * f + row, static_cast<int>(g.col()),
                               frame(row, axis) * g.value() / T.unit);
  }
  SpMat out(3 * Eigen::Index{mesh.n_faces()}, mesh.n_vertices());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

template <class Scalar>
void check_square(const Eigen::SparseMatrix<Scalar>& A) {
  if (A.rows() != A.cols())
    throw InputError("the matrix is " + std::to_string(A.rows()) + " x " +
                         std::to_string(A.cols()) + ", which is not square",
                     "sizes-differ");
  for (Eigen::Index j = 0; j < A.outerSize(); ++j)
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator a(A, j); a; ++a)
      if (!std::isfinite(std::abs(a.value())))
        throw InputError("entry " + std::to_string(a.row()) + ", " + std::to_string(a.col()) +
                             " of the matrix is not finite",
                         "not-finite");
}

template <class Scalar>
Eigen::SparseMatrix<Scalar> lower_of(const Eigen::SparseMatrix<Scalar>& A) {
  Eigen::SparseMatrix<Scalar> lower = A.template triangularView<Eigen::Lower>();
  lower.makeCompressed();
  return lower;
}

}  // namespace

SurfaceOperators surface_operators(const Mesh& mesh, const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    const SurfaceDiscretization surface(mesh.domain(), task, report);
    const Operators& ops = *surface.operators();
    const double unit2 = ops.unit * ops.unit;
    SurfaceOperators out;
    out.L = whole(ops.scalar.L);
    out.M = ops.scalar.M * unit2;
    if (surface.triangulation()) {
      const IntrinsicTriangulation& T = *surface.triangulation();
      out.G = gradient_in_space(mesh, T, ops.scalar.G.matrix());
      out.A = VecX::Zero(mesh.n_faces());
      VecX weight = VecX::Zero(3 * out.A.size());
      for (int f = 0; f < mesh.n_faces(); ++f) {
        const int t = T.triangle_of_face[f];
        if (t >= 0) out.A[f] = ops.scalar.A[t] * unit2;
        weight.segment<3>(3 * f).setConstant(out.A[f]);
      }
      out.D = SpMat(out.G.transpose()) * weight.asDiagonal();
    }
    if (ops.vector.complex_linear()) out.connection = whole(ops.vector.L({}));
    out.connection_mass = ops.vector.M * unit2;
    out.vector_at = ops.vector.ends.matrix();
    return out;
  });
}

struct Factorization::Impl {
  std::optional<Cholesky<double>> real;
  std::optional<Cholesky<Complex>> complex;
  Eigen::Index n = 0;
  // Of a Laplacian: the connected part of each unknown, and the first unknown of each, held at 0.
  std::vector<int> part, first;
  std::vector<int> size;  // of each part

  /// Takes the mean over each part out of every column.
  void centre(MatX& B) const {
    MatX mean = MatX::Zero(std::ssize(first), B.cols());
    for (Eigen::Index i = 0; i < n; ++i) mean.row(part[i]) += B.row(i);
    for (Eigen::Index p = 0; p < mean.rows(); ++p) mean.row(p) /= size[p];
    for (Eigen::Index i = 0; i < n; ++i) B.row(i) -= mean.row(part[i]);
  }
};

Factorization::Factorization(const SpMat& A, Definite definite, const Context& context) {
  check_square(A);
  impl_ = run(context, [&](const Task& task) {
    auto impl = std::make_shared<Impl>();
    impl->n = A.rows();
    SpMat lower = lower_of(A);
    if (definite == Definite::laplacian) {
      DisjointSets sets(static_cast<int>(A.rows()));
      for (Eigen::Index j = 0; j < lower.outerSize(); ++j)
        for (SpMat::InnerIterator a(lower, j); a; ++a)
          if (a.value() != 0) sets.join(static_cast<int>(a.row()), static_cast<int>(j));
      int parts = 0;
      impl->part = sets.numbered(parts);
      impl->first.assign(std::size_t(parts), -1);
      impl->size.assign(std::size_t(parts), 0);
      for (int i = 0; i < A.rows(); ++i) {
        const auto part = std::size_t(impl->part[i]);
        if (impl->size[part]++ == 0) impl->first[part] = i;
      }
      lower.prune([&](Eigen::Index i, Eigen::Index j, double) {
        const auto held = [&](Eigen::Index k) { return impl->first[impl->part[k]] == k; };
        return !held(i) && !held(j);
      });
      for (const int i : impl->first) lower.coeffRef(i, i) = 1;
      lower.makeCompressed();
    }
    impl->real.emplace(lower, task);
    return impl;
  });
}

Factorization::Factorization(const SpMatC& A, const Context& context) {
  check_square(A);
  impl_ = run(context, [&](const Task& task) {
    auto impl = std::make_shared<Impl>();
    impl->n = A.rows();
    impl->complex.emplace(lower_of(A), task);
    return impl;
  });
}

namespace {

template <class Matrix>
void check_right_hand_side(const Matrix& B, Eigen::Index n) {
  if (B.rows() != n)
    throw InputError("the right-hand side has " + std::to_string(B.rows()) + " rows, the matrix " +
                         std::to_string(n),
                     "sizes-differ");
  if (!B.allFinite())
    throw InputError("the right-hand side has numbers that are not finite", "not-finite");
}

}  // namespace

MatX Factorization::solve(const MatX& B, const Context& context) const {
  check_right_hand_side(B, impl_->n);
  if (!impl_->real)
    throw InputError("the matrix is complex, the right-hand side is not", "sizes-differ");
  return run(context, [&](const Task&) -> MatX {
    if (impl_->first.empty()) return impl_->real->solve(B);
    MatX centred = B;
    impl_->centre(centred);
    for (const int i : impl_->first) centred.row(i).setZero();
    MatX x = impl_->real->solve(centred);
    impl_->centre(x);
    return x;
  });
}

Eigen::MatrixXcd Factorization::solve(const Eigen::MatrixXcd& B, const Context& context) const {
  check_right_hand_side(B, impl_->n);
  if (!impl_->complex)
    throw InputError("the right-hand side is complex, the matrix is not", "sizes-differ");
  return run(context, [&](const Task&) -> Eigen::MatrixXcd { return impl_->complex->solve(B); });
}

int Factorization::size() const { return static_cast<int>(impl_->n); }
double Factorization::nonzeros() const {
  return impl_->real ? impl_->real->nonzeros() : impl_->complex->nonzeros();
}

}  // namespace littoral
