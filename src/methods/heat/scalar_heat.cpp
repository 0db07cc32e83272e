#include "methods/heat/scalar_heat.h"

#include <algorithm>
#include <cmath>

namespace littoral {

namespace {

/// M + t L, lower triangle; rows and columns of `dropped` nodes and of nodes without mass become
/// those of the identity.
SpMat heat_matrix(const Calculus& C, double t, const std::vector<char>& dropped) {
  Triplets entries;
  entries.reserve(C.L.nonZeros() + C.L.rows());
  auto drop = [&](Eigen::Index i) { return dropped[i] || !(C.M[i] > 0); };
  for (int j = 0; j < C.L.outerSize(); ++j) {
    entries.emplace_back(j, j, drop(j) ? 1.0 : C.M[j]);
    for (SpMat::InnerIterator it(C.L, j); it; ++it)
      if (!drop(j) && !drop(it.row())) entries.emplace_back(it.row(), j, t * it.value());
  }
  SpMat A(C.L.rows(), C.L.cols());
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

}  // namespace

ScalarHeat::ScalarHeat(const Calculus& C, double t, SolveHint hint, const Ordering& order,
                       const Task& task)
    : root_t_(std::sqrt(t)) {
  auto system = [&](const std::vector<char>& dropped) {
    return std::make_shared<const HeatSystem<double>>(
        std::make_shared<const SpMat>(heat_matrix(C, t, dropped)), 1, decay_lengths(C.M, t), hint,
        task, order);
  };
  neumann_ = system(std::vector<char>(C.boundary.size(), 0));
  if (std::find(C.boundary.begin(), C.boundary.end(), 1) != C.boundary.end())
    dirichlet_ = system(C.boundary);
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
