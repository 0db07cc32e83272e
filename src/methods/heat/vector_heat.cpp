#include "methods/heat/vector_heat.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace littoral {

namespace {

/// M + t L, lower triangle, in the place of L, as Eigen would copy it; dofs without mass get a unit
/// diagonal.
template <class Scalar>
std::shared_ptr<const Eigen::SparseMatrix<Scalar>> heat_matrix(
    const std::function<Eigen::SparseMatrix<Scalar>(const Task&)>& L, const VecX& M, double t,
    const Task& task) {
  const std::shared_ptr<Eigen::SparseMatrix<Scalar>> made(new Eigen::SparseMatrix<Scalar>(L(task)));
  Eigen::SparseMatrix<Scalar>& A = *made;
  const Eigen::Index block = A.rows() / M.size();
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
  return made;
}

Eigen::Map<const VecXc> as_complex(const VecX& X) {
  return {reinterpret_cast<const Complex*>(X.data()), X.size() / 2};
}

ScaledField<double> as_pairs(ScaledField<Complex> field) {
  const auto* pairs = reinterpret_cast<const double*>(field.x.data());  // as C++ lays them out
  return {Eigen::Map<const VecX>(pairs, 2 * field.x.size()), std::move(field.layer),
          std::move(field.scale)};
}

}  // namespace

VectorHeat::VectorHeat(const VectorDiffusion& V, double t, SolveHint hint,
                       std::shared_ptr<const Ordering> nodes, const Task& task)
    : t_(t), hint_(hint), nodes_(std::move(nodes)) {
  if (largest_to_factor(hint) >= (V.complex_linear() ? 1 : 2) * V.M.size())
    kept_ = std::make_shared<const System>(system(V, task));
}

VectorHeat::System VectorHeat::system(const VectorDiffusion& V, const Task& task) const {
  Ordering order = V.at_nodes ? *nodes_ : V.ends ? between_nodes(*nodes_, *V.ends) : Ordering();
  task.checkpoint();
  if (V.complex_linear())
    return {std::make_shared<const HeatSystem<Complex>>(heat_matrix(V.L, V.M, t_, task), 1,
                                                        decay_lengths(V.M, t_), hint_, task,
                                                        std::move(order)),
            nullptr};
  return {nullptr, std::make_shared<const HeatSystem<double>>(heat_matrix(V.L_real, V.M, t_, task),
                                                              2, decay_lengths(V.M, t_), hint_,
                                                              task, std::move(order))};
}

ScaledField<double> VectorHeat::solve(const VectorDiffusion& V, VecX X0, const Task& task,
                                      Report& report) const {
  const auto sources = nonzero_blocks(as_complex(X0), 1);
  X0.resize(0);  // beside the largest matrix there is
  const System S = kept_ ? *kept_ : system(V, task);
  if (S.complex) return as_pairs(S.complex->solve(sources, V.piece, task, report));
  const auto* pairs = reinterpret_cast<const double*>(sources.value.data());
  return S.real->solve(
      HeatSource<double>{sources.blocks, Eigen::Map<const VecX>(pairs, 2 * sources.value.size())},
      V.piece, task, report);
}

CellField VectorHeat::diffuse(const VectorDiffusion& V, VecX X0, const Task& task,
                              Report& report) const {
  return cell_field(V.to_cells, solve(V, std::move(X0), task, report));
}

CellField VectorHeat::diffuse_prescribed(const VectorDiffusion& V, const VecX& values,
                                         const Task& task, Report& report) const {
  const System S = kept_ ? *kept_ : system(V, task);
  return cell_field(
      V.to_cells,
      S.complex ? as_pairs(S.complex->solve_prescribed(as_complex(values), V.piece, task, report))
                : S.real->solve_prescribed(values, V.piece, task, report));
}

double VectorHeat::nonzeros() const {
  if (!kept_) return 0;
  return kept_->complex ? kept_->complex->nonzeros() : kept_->real->nonzeros();
}

}  // namespace littoral
