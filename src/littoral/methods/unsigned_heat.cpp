#include "littoral/methods/unsigned_heat.h"

#include <algorithm>

#include "littoral/methods/shift.h"
#include "littoral/methods/vector_heat.h"

namespace littoral {

const OptionTable<UnsignedHeatOptions>& unsigned_heat_options() {
  using O = UnsignedHeatOptions;
  static const OptionTable<O> table = OptionTable<O>().number(
      &O::time_scale, "time-scale", "multiple of h^2", 1e-6, 1e6,
      "Diffusion time t as a multiple of h^2, h being the mean edge length.");
  return table;
}

namespace {

/// M + t L, lower triangle; rows and columns of `dropped` nodes and of nodes without mass become
/// those of the identity.
SpMat heat_matrix(const Calculus& C, double t, const std::vector<char>& dropped) {
  Triplets entries;
  entries.reserve(static_cast<std::size_t>(C.L.nonZeros()) + static_cast<std::size_t>(C.L.rows()));
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

UnsignedHeat::UnsignedHeat(std::shared_ptr<const Operators> ops, const UnsignedHeatOptions& options,
                           Task task)
    : ops_(std::move(ops)),
      poisson_(ops_->scalar.L, ops_->scalar.component, ops_->scalar.n_components,
               task.stage(0.4, "factor Poisson")) {
  const Calculus& C = ops_->scalar;
  const double t = options.time_scale * C.h * C.h;
  const std::vector<char> none(C.boundary.size(), 0);
  neumann_ = std::make_shared<const HeatSystem<double>>(heat_matrix(C, t, none), 1,
                                                        task.stage(0.3, "factor heat"));
  if (std::find(C.boundary.begin(), C.boundary.end(), 1) != C.boundary.end())
    dirichlet_ = std::make_shared<const HeatSystem<double>>(heat_matrix(C, t, C.boundary), 1,
                                                            task.stage(0.3, "factor heat"));
}

VecX UnsignedHeat::solve(const SourceTerms& terms, Task task, Report& report) const {
  const Calculus& C = ops_->scalar;
  const Task heat_stage = task.stage(0.5, "diffuse"), poisson_stage = task.stage(0.5, "integrate");
  VecX u0 = terms.u0;
  for (Eigen::Index i = 0; i < u0.size(); ++i)
    if (!(C.M[i] > 0)) u0[i] = 0;
  LayeredField<double> u = neumann_->solve(u0, C.component, heat_stage, report);
  if (dirichlet_) {
    // Mean of both where they are on the same scale: within the first layer. Beyond, hundreds of
    // spacings away, the Neumann solution alone; its bias is a boundary layer one spacing wide.
    VecX b = u0;
    for (Eigen::Index i = 0; i < b.size(); ++i)
      if (C.boundary[i]) b[i] = 0;
    Report inner;
    const LayeredField<double> d = dirichlet_->solve(b, C.component, heat_stage, inner);
    add_dirichlet(u0, b, d, u);
  }
  int zeros = 0;
  const VecX Y = normalize(-cell_directions(C.G, u), zeros);
  VecX phi = poisson_.solve_levels(C.divergence(Y),
                                   {terms.A, std::vector<int>(terms.group.size(), 0), {1}},
                                   poisson_stage, report);
  return finish_field(*ops_, terms, phi.cwiseMax(0.0), report);
}

void UnsignedHeat::add_dirichlet(const VecX& u0, const VecX& b, const LayeredField<double>& d,
                                 LayeredField<double>& u) const {
  const Calculus& C = ops_->scalar;
  VecX scale_u = VecX::Zero(C.n_components), scale_d = scale_u;  // solve scaled each piece to 1
  for (Eigen::Index i = 0; i < u0.size(); ++i) {
    if (C.component[i] < 0) continue;
    scale_u[C.component[i]] = std::max(scale_u[C.component[i]], std::abs(u0[i]));
    scale_d[C.component[i]] = std::max(scale_d[C.component[i]], std::abs(b[i]));
  }
  for (Eigen::Index i = 0; i < u0.size(); ++i) {
    const int c = C.component[i];
    if (c < 0 || u.layer[i] != 0) continue;
    const double dirichlet = d.layer[i] == 0 ? d.x[i] * scale_d[c] / scale_u[c] : 0;
    u.x[i] = 0.5 * (u.x[i] + dirichlet);
  }
}

}  // namespace littoral
