#include "methods/heat/unsigned_heat.h"

#include <cmath>

#include "methods/heat/finalize.h"
#include "methods/heat/time_scale.h"

namespace littoral {

const OptionTable<UnsignedHeat>& unsigned_heat_options() {
  using O = UnsignedHeat;
  static const OptionTable<O> table =
      OptionTable<O>()
          .number(&O::time_scale, "time-scale", "multiple of h^2, 0 = automatic", 0, 1e6,
                  "Diffusion time t as a multiple of h^2, h being the mean edge length.")
          .toggle(&O::intrinsic_delaunay, "intrinsic-delaunay",
                  "Flips and refines the triangles intrinsically first; for bad triangulations.");
  return table;
}

UnsignedHeatSolver::UnsignedHeatSolver(std::shared_ptr<const Operators> ops,
                                       const UnsignedHeat& options, Task task, SolveHint hint)
    : ops_(std::move(ops)),
      hint_(hint),
      root_t_(ops_->scalar.h * std::sqrt(options.time_scale > 0 ? options.time_scale : 1)),
      order_(
          std::make_shared<const Ordering>(dissection(ops_->scalar.L, task.stage(0.3, "order")))),
      poisson_(std::make_shared<const Poisson>(
          std::shared_ptr<const SpMat>(ops_, &ops_->scalar.L), ops_->scalar.component,
          ops_->scalar.n_components, task.stage(0.3, "factor Poisson"), *order_, solver_for(hint))),
      heat_(ops_->scalar, root_t_ * root_t_, hint, order_, poisson_->structure(),
            task.stage(0.4, "factor heat")) {}

UnsignedHeatSolver UnsignedHeatSolver::with_time_scale(double time_scale, const Task& task) const {
  UnsignedHeatSolver out = *this;
  out.root_t_ = ops_->scalar.h * std::sqrt(time_scale);
  out.heat_ = ScalarHeat(ops_->scalar, out.root_t_ * out.root_t_, hint_, order_,
                         poisson_->structure(), task);
  return out;
}

VecX UnsignedHeatSolver::solve(const SourceSystem& system, Task task, Report& report) const {
  const Calculus& C = ops_->scalar;
  const Task heat_stage = task.stage(0.5, "diffuse"), poisson_stage = task.stage(0.5, "integrate");

  // Y = -grad u / |grad u|.
  CellField X = no_field(C.A.size());
  heat_.add_nearest(C, system, point_to_line * root_t_ / C.h, X, heat_stage, report);
  set_near(C, system, X.Y);

  // L phi = G^T A Y, phi = d0 + psi with psi = 0 at the sources.
  const VecX b = C.divergence(X.Y - C.G.apply(system.d0));
  const VecX psi = poisson_->solve_levels(
      b, {system.A, std::vector<int>(system.group.size(), 0), {1}, system.value}, poisson_stage,
      report);
  report_gradient(C, system.d0 + psi, X.Y, report);
  return finalize_field(*ops_, system, (system.d0 + psi).cwiseMax(0.0), report);
}

}  // namespace littoral
