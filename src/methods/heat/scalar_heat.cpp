#include "methods/heat/scalar_heat.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/taken.h"
#include "methods/heat/heat_matrix.h"

namespace littoral {

namespace {

/// A with rows and columns of the marked unknowns those of the identity, and all entries in their
/// places. Lower triangle, diagonal first.
std::shared_ptr<const SpMat> with_identity(const SpMat& A, const std::vector<char>& dropped) {
  SpMat out = A;
  for (int j = 0; j < out.outerSize(); ++j)
    for (SpMat::InnerIterator it(out, j); it; ++it)
      if (dropped[j] || dropped[it.row()]) it.valueRef() = it.row() == j ? 1 : 0;
  return shared_taken(out);
}

}  // namespace

ScalarHeat::ScalarHeat(const Calculus& C, double t, SolveHint hint, const Ordering& order,
                       const std::shared_ptr<const Elimination>& structure, const Task& task)
    : root_t_(std::sqrt(t)) {
  const auto system = [&](std::shared_ptr<const SpMat> A) {
    return std::make_shared<const HeatSystem<double>>(std::move(A), 1, decay_lengths(C.M, t), hint,
                                                      task, order, structure);
  };
  const auto is_set = [](char marked) { return marked != 0; };
  std::vector<char> dropped(C.boundary.size(), 0);
  for (Eigen::Index i = 0; i < C.M.size(); ++i) dropped[i] = !(C.M[i] > 0);
  auto A = heat_matrix<double>([&](const Task&) { return C.L; }, C.M, t, task);
  if (std::ranges::any_of(dropped, is_set)) A = with_identity(*A, dropped);
  if (std::ranges::any_of(C.boundary, is_set)) dirichlet_ = system(with_identity(*A, C.boundary));
  neumann_ = system(std::move(A));
}

CellField ScalarHeat::flow(const Calculus& C, const VecX& u0, const Task& task,
                           Report& report) const {
  VecX b = u0;
  for (Eigen::Index i = 0; i < b.size(); ++i)
    if (!(C.M[i] > 0)) b[i] = 0;
  const HeatSource<double> source = nonzero_blocks(b, 1);
  ScaledField<double> u = neumann_->solve(source, C.component, task, report);
  restore_units(u, source, C.component);
  if (dirichlet_) {
    // Mean of both where they are on the same scale: within the first layer. Beyond, hundreds of
    // spacings away, the Neumann solution alone; its bias is a boundary layer one spacing wide.
    for (Eigen::Index i = 0; i < b.size(); ++i)
      if (C.boundary[i]) b[i] = 0;
    Report inner;
    const HeatSource<double> inside = nonzero_blocks(b, 1);
    ScaledField<double> d = dirichlet_->solve(inside, C.component, task, inner);
    restore_units(d, inside, C.component);
    const double unit = d.scale[0] / u.scale[0];  // differ where a source reaches the boundary
    for (Eigen::Index i = 0; i < b.size(); ++i)
      if (u.layer[i] == 0) u.x[i] = 0.5 * (u.x[i] + (d.layer[i] == 0 ? unit * d.x[i] : 0));
  }
  u.x = -u.x;
  return cell_field(C.G, u);
}

void ScalarHeat::add_nearest(const Calculus& C, const SourceSystem& system, double point_weight,
                             CellField& field, Task task, Report& report) const {
  Report least;  // what every batch has to say, one batch has to say
  double passes = 0;
  const Eigen::Index n_batches = system.u0.cols();
  for (Eigen::Index k = 0; k < n_batches; ++k) {
    Report inner;
    const CellField flow = this->flow(C, VecX(system.u0.col(k)),
                                      task.stage(1.0 / double(n_batches), "diffuse"), inner);
    take_longer(
        field, flow,
        (system.batch_of_points[k] ? std::log(point_weight) : 0) - system.batch_value[k] / root_t_);
    for (const auto& [loop, count] : inner.iterations) passes += count;
    if (k == 0 || inner.warnings.size() < least.warnings.size()) least = inner;
  }
  report.iterations.emplace_back("heat passes", passes);
  for (const auto& [code, text] : least.warnings) report.warn(code, text);
}

}  // namespace littoral
