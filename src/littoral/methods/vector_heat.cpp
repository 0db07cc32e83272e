#include "littoral/methods/vector_heat.h"

#include <algorithm>
#include <cmath>

namespace littoral {

namespace {

/// M + t L, lower triangle; carriers without mass get a unit diagonal.
template <class Scalar>
Eigen::SparseMatrix<Scalar> heat_matrix(const Eigen::SparseMatrix<Scalar>& L, const VecX& M,
                                        double t) {
  const Eigen::Index block = L.rows() / M.size();
  std::vector<Eigen::Triplet<Scalar>> entries;
  entries.reserve(static_cast<std::size_t>(L.rows()));
  for (Eigen::Index i = 0; i < L.rows(); ++i) {
    const double m = M[i / block];
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), m > 0 ? m : 1.0);
  }
  Eigen::SparseMatrix<Scalar> D(L.rows(), L.cols());
  D.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseMatrix<Scalar> A = D + Scalar(t) * L;
  A.makeCompressed();
  return A;
}

VecXc to_complex(const VecX& X) {
  VecXc z(X.size() / 2);
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = {X[2 * i], X[2 * i + 1]};
  return z;
}

const VecX& as_unknowns(const VecX& X, const HeatSystem<double>&) { return X; }
VecXc as_unknowns(const VecX& X, const HeatSystem<Complex>&) { return to_complex(X); }

LayeredField<double> as_pairs(LayeredField<double> field) { return field; }
LayeredField<double> as_pairs(const LayeredField<Complex>& field) {
  LayeredField<double> pairs{VecX(2 * field.x.size()), field.layer, field.scale};
  for (Eigen::Index i = 0; i < field.x.size(); ++i) {
    pairs.x[2 * i] = field.x[i].real();
    pairs.x[2 * i + 1] = field.x[i].imag();
  }
  return pairs;
}

/// Eliminates the carriers held at given values: their rows and columns move to the right-hand
/// side.
template <class Scalar>
LayeredField<double> solve_held(const HeatSystem<Scalar>& system, const VecX& held,
                                const std::vector<int>& piece, const Task& task, Report& report) {
  const int block = system.block();
  const typename HeatSystem<Scalar>::Vector x = as_unknowns(held, system);
  auto hold = [&](Eigen::Index i) {
    const Eigen::Index c = i / block;
    return held[2 * c] != 0 || held[2 * c + 1] != 0;
  };
  typename HeatSystem<Scalar>::Vector b = x;
  std::vector<Eigen::Triplet<Scalar>> entries;
  const auto& A = system.matrix();
  for (int j = 0; j < A.outerSize(); ++j) {
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(A, j); it; ++it) {
      const Eigen::Index i = it.row();
      if (i == j) {
        entries.emplace_back(int(i), j, hold(i) ? Scalar(1) : it.value());
      } else if (!hold(i) && !hold(j)) {
        entries.emplace_back(int(i), j, it.value());
      } else if (!hold(i)) {
        b[i] -= it.value() * x[j];
      } else if (!hold(j)) {
        b[j] -= Eigen::numext::conj(it.value()) * x[i];
      }
    }
  }
  Eigen::SparseMatrix<Scalar> reduced(A.rows(), A.cols());
  reduced.setFromTriplets(entries.begin(), entries.end());
  return as_pairs(
      HeatSystem<Scalar>(std::move(reduced), block, task).solve(b, piece, task, report));
}

}  // namespace

VectorHeat::VectorHeat(const VectorDiffusion& V, double t, const Task& task) {
  if (V.complex_linear())
    complex_ = std::make_shared<const HeatSystem<Complex>>(heat_matrix(V.L, V.M, t), 1, task);
  else
    real_ = std::make_shared<const HeatSystem<double>>(heat_matrix(V.L_real, V.M, t), 2, task);
}

CellField VectorHeat::diffuse(const VectorDiffusion& V, const VecX& X0, const Task& task,
                              Report& report) const {
  auto X = complex_ ? as_pairs(complex_->solve(to_complex(X0), V.piece, task, report))
                    : real_->solve(X0, V.piece, task, report);
  restore_units(X, X0, V.piece);
  return cell_field(V.to_cells, X);
}

CellField VectorHeat::diffuse_held(const VectorDiffusion& V, const VecX& held, const Task& task,
                                   Report& report) const {
  const auto X = complex_ ? solve_held(*complex_, held, V.piece, task, report)
                          : solve_held(*real_, held, V.piece, task, report);
  return cell_field(V.to_cells, X);
}

double VectorHeat::nonzeros() const { return complex_ ? complex_->nonzeros() : real_->nonzeros(); }

}  // namespace littoral
