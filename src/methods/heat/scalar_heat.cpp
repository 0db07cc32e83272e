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

/// -grad u for (M + t L) u = u0.
CellField flow(const Calculus& C, const ScalarHeat::Systems& systems, const VecX& u0,
               const Task& task, Report& report) {
  VecX b = u0;
  for (Eigen::Index i = 0; i < b.size(); ++i)
    if (!(C.M[i] > 0)) b[i] = 0;
  const HeatSource<double> source = nonzero_blocks(b, 1);
  ScaledField<double> u = systems.neumann->solve(source, C.component, task, report);
  restore_units(u, source, C.component);
  if (systems.dirichlet) {
    // Mean of both where they are on the same scale: within the first layer. Beyond, hundreds of
    // spacings away, the Neumann solution alone; its bias is a boundary layer one spacing wide.
    for (Eigen::Index i = 0; i < b.size(); ++i)
      if (C.boundary[i]) b[i] = 0;
    Report inner;
    const HeatSource<double> inside = nonzero_blocks(b, 1);
    ScaledField<double> d = systems.dirichlet->solve(inside, C.component, task, inner);
    restore_units(d, inside, C.component);
    const double unit = d.scale[0] / u.scale[0];  // differ where a source reaches the boundary
    for (Eigen::Index i = 0; i < b.size(); ++i)
      if (u.layer[i] == 0) u.x[i] = 0.5 * (u.x[i] + (d.layer[i] == 0 ? unit * d.x[i] : 0));
  }
  u.x = -u.x;
  return cell_field(C.G, u);
}

}  // namespace

ScalarHeat::ScalarHeat(const Calculus& C, double t, SolveHint hint,
                       std::shared_ptr<const Ordering> order,
                       std::shared_ptr<const Elimination> structure, const Task& task)
    : t_(t), hint_(hint), order_(std::move(order)), structure_(std::move(structure)) {
  if (C.M.size() <= largest_to_factor(hint))
    kept_ = std::make_shared<const Systems>(systems(C, task));
}

ScalarHeat::Systems ScalarHeat::systems(const Calculus& C, const Task& task) const {
  task.checkpoint();
  const auto system = [&](std::shared_ptr<const SpMat> A) {
    return std::make_shared<const HeatSystem<double>>(std::move(A), 1, C.M, hint_, task,
                                                      order_ ? *order_ : Ordering(), structure_);
  };
  const auto is_set = [](char marked) { return marked != 0; };
  std::vector<char> dropped(C.boundary.size(), 0);
  for (Eigen::Index i = 0; i < C.M.size(); ++i) dropped[i] = !(C.M[i] > 0);
  auto A = heat_matrix<double>([&](const Task&) { return C.L; }, C.M, t_, task);
  if (std::ranges::any_of(dropped, is_set)) A = with_identity(*A, dropped);
  Systems out;
  if (std::ranges::any_of(C.boundary, is_set))
    out.dirichlet = system(with_identity(*A, C.boundary));
  out.neumann = system(std::move(A));
  return out;
}

double ScalarHeat::nonzeros() const {
  if (!kept_) return 0;
  return kept_->neumann->nonzeros() + (kept_->dirichlet ? kept_->dirichlet->nonzeros() : 0);
}

void ScalarHeat::add_nearest(const Calculus& C, const SourceSystem& system, double point_weight,
                             CellField& field, Task task, Report& report) const {
  Report least;  // what every batch has to say, one batch has to say
  double passes = 0;
  const Systems S = kept_ ? *kept_ : systems(C, task);
  const Eigen::Index n_batches = system.u0.cols();
  for (Eigen::Index k = 0; k < n_batches; ++k) {
    Report inner;
    const CellField X =
        flow(C, S, VecX(system.u0.col(k)), task.stage(1.0 / double(n_batches), "diffuse"), inner);
    take_longer(field, X,
                (system.batch_of_points[k] ? std::log(point_weight) : 0) -
                    system.batch_value[k] / std::sqrt(t_));
    for (const auto& [loop, count] : inner.iterations) passes += count;
    if (k == 0 || inner.warnings.size() < least.warnings.size()) least = inner;
  }
  report.iterations.emplace_back("heat passes", passes);
  for (const auto& [code, text] : least.warnings) report.warn(code, text);
}

}  // namespace littoral
