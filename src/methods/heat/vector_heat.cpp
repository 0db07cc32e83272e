#include "methods/heat/vector_heat.h"

#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "methods/heat/heat_matrix.h"

namespace littoral {

namespace {

Eigen::Map<const VecXc> as_complex(const VecX& X) {
  return {reinterpret_cast<const Complex*>(X.data()), X.size() / 2};
}

ScaledField<double> as_pairs(ScaledField<Complex> field) {
  constexpr std::size_t pair_grain = 1 << 16;
  VecX x(2 * field.x.size());
  parallel_for(std::size_t(field.x.size()), pair_grain, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index i = index(begin); i < index(end); ++i) {
      x[2 * i] = field.x[i].real();
      x[2 * i + 1] = field.x[i].imag();
    }
  });
  return {std::move(x), std::move(field.layer), std::move(field.scale)};
}

}  // namespace

VectorHeat::VectorHeat(const VectorDiffusion& V, double t, SolveHint hint,
                       std::shared_ptr<const Ordering> nodes, const Task& task)
    : t_(t), hint_(hint), nodes_(std::move(nodes)) {
  if (largest_to_factor(hint) >= (V.complex_linear() ? 1 : 2) * V.M.size())
    kept_ = std::make_shared<const System>(system(V, task));
}

VectorHeat::System VectorHeat::system(const VectorDiffusion& V, const Task& task) const {
  Ordering order = V.at_nodes          ? *nodes_
                   : V.ends.rows() > 0 ? between_nodes(*nodes_, V.ends.matrix())
                                       : Ordering();
  task.checkpoint();
  if (V.L_rows && V.n > largest_to_factor(hint_))
    return {std::make_shared<const HeatSystem<Complex>>(heat_rows(V.L_rows(), V.M, t_), V.M, order),
            nullptr};
  if (V.complex_linear())
    return {std::make_shared<const HeatSystem<Complex>>(heat_matrix(V.L, V.M, t_, task), 1, V.M,
                                                        hint_, task, std::move(order)),
            nullptr};
  return {nullptr,
          std::make_shared<const HeatSystem<double>>(heat_matrix(V.L_real, V.M, t_, task), 2, V.M,
                                                     hint_, task, std::move(order))};
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
