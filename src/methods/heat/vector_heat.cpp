#include "methods/heat/vector_heat.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace littoral {

namespace {

/// M + t L, lower triangle; dofs without mass get a unit diagonal.
template <class Scalar>
Eigen::SparseMatrix<Scalar> heat_matrix(const Eigen::SparseMatrix<Scalar>& L, const VecX& M,
                                        double t) {
  const Eigen::Index block = L.rows() / M.size();
  Eigen::SparseMatrix<Scalar> A = L;  // no temporary matrices: this is the largest one there is
  A.makeCompressed();
  A.coeffs() *= t;
  std::vector<int> missing;
  for (Eigen::Index i = 0; i < A.cols(); ++i) {
    const int first = A.outerIndexPtr()[i];  // the diagonal, in a lower triangle, if there is one
    if (first < A.outerIndexPtr()[i + 1] && A.innerIndexPtr()[first] == i)
      A.valuePtr()[first] += M[i / block] > 0 ? M[i / block] : 1.0;
    else
      missing.push_back(i);
  }
  for (int i : missing) A.coeffRef(i, i) = M[i / block] > 0 ? M[i / block] : 1.0;
  A.makeCompressed();
  return A;
}

VecXc to_complex(const VecX& X) {
  return Eigen::Map<const VecXc>(reinterpret_cast<const Complex*>(X.data()), X.size() / 2);
}

ScaledField<double> as_pairs(ScaledField<Complex> field) {
  const auto* pairs = reinterpret_cast<const double*>(field.x.data());  // as C++ lays them out
  return {Eigen::Map<const VecX>(pairs, 2 * field.x.size()), std::move(field.layer),
          std::move(field.scale)};
}

}  // namespace

VectorHeat::VectorHeat(const VectorDiffusion& V, double t, SolveHint hint, const Ordering& nodes,
                       const Task& task) {
  Ordering order = V.at_nodes          ? nodes
                   : V.ends.rows() > 0 ? between_nodes(nodes, V.ends)
                                       : Ordering();
  task.checkpoint();
  if (V.complex_linear())
    complex_ = std::make_shared<const HeatSystem<Complex>>(
        heat_matrix(V.L, V.M, t), 1, decay_lengths(V.M, t), hint, task, std::move(order));
  else
    real_ = std::make_shared<const HeatSystem<double>>(
        heat_matrix(V.L_real, V.M, t), 2, decay_lengths(V.M, t), hint, task, std::move(order));
}

CellField VectorHeat::diffuse(const VectorDiffusion& V, const VecX& X0, const Task& task,
                              Report& report) const {
  auto X = complex_ ? as_pairs(complex_->solve(to_complex(X0), V.piece, task, report))
                    : real_->solve(X0, V.piece, task, report);
  restore_units(X, X0, V.piece);
  return cell_field(V.to_cells, X);
}

CellField VectorHeat::diffuse_prescribed(const VectorDiffusion& V, const VecX& values,
                                         const Task& task, Report& report) const {
  const auto X =
      complex_ ? as_pairs(complex_->solve_prescribed(to_complex(values), V.piece, task, report))
               : real_->solve_prescribed(values, V.piece, task, report);
  return cell_field(V.to_cells, X);
}

double VectorHeat::nonzeros() const { return complex_ ? complex_->nonzeros() : real_->nonzeros(); }

}  // namespace littoral
