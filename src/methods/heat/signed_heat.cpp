#include "methods/heat/signed_heat.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "methods/heat/finalize.h"
#include "methods/heat/time_scale.h"

namespace littoral {

const OptionTable<SignedHeat>& signed_heat_options() {
  using O = SignedHeat;
  static const OptionTable<O> table =
      OptionTable<O>()
          .number(
              &O::time_scale, "time-scale", "multiple of h^2, 0 = automatic", 0, 1e6,
              "Diffusion time t as a multiple of h^2, h being half the mean edge length; larger "
              "values smooth more and close wider gaps.")
          .choice(&O::constraint, "constraint", {"none", "zero-set", "level-sets"},
                  "Values at the source: shifted to mean zero, all zero, or constant along each "
                  "connected part.")
          .number(&O::soft, "soft", "weight per mean edge length of source, 0 = off", 0, 1e12,
                  "Replaces the constraint by a penalty on the squared value along the source.")
          .toggle(&O::preserve_normals, "preserve-normals",
                  "Holds the diffused vectors at the source's own normals.")
          .choice(
              &O::point_sources, "point-sources", {"gradient", "radial"},
              "Diffused vectors of points: the gradient of scalar heat, each cell's from the "
              "nearest point; or radial vectors at the points, all in one sum, as in the paper. "
              "Beside curves always radial.")
          .toggle(&O::intrinsic_delaunay, "intrinsic-delaunay",
                  "Flips and refines the triangles intrinsically first; for bad triangulations.")
          .toggle(&O::discontinuous, "discontinuous",
                  "Lets the distance jump where the directions cannot be integrated: for curves "
                  "without inside and outside.")
          .number(&O::jump_threshold, "jump-threshold", "mean edge lengths", 0, 1e6,
                  "Discontinuous: jumps larger than that stay, smaller ones are smoothed out.")
          .number(&O::smoothing, "smoothing", "multiple of h^2, 0 = none", 0, 1e6,
                  "Discontinuous: time of the heat flow that smooths out small jumps, h being the "
                  "mean edge length; 0 leaves all jumps.")
          .choice(&O::sharpen, "sharpen", {"off", "on", "quadratic"},
                  "Afterwards makes the distance as large as a unit gradient allows, with the same "
                  "signs: "
                  "on linear elements, or on quadratic ones from the curves and the zero set in "
                  "their gaps (triangle and polygon meshes).")
          .choice(&O::sharpen_solver, "sharpen-solver", {"admm", "pdhg"},
                  "Sharpening by alternating directions, or by the primal-dual hybrid gradient "
                  "method, which factors nothing.")
          .toggle(&O::bounding_only, "bounding-only",
                  "Leaves out the parts of signed curves that bound nothing (surface winding "
                  "numbers).");
  return table;
}

double automatic_time_scale(const SourceSystem& system) { return system.only_points ? 16 : 1; }

namespace {

/// Do points enter as gradients of scalar heat? Beside curves they cannot: the two discrete kernels
/// fall at different rates.
bool by_gradient(const SourceSystem& system, const SignedHeat& options) {
  return options.point_sources == PointVectors::gradient && system.only_points &&
         !options.preserve_normals;
}

}  // namespace

Diffusions needed_diffusions(const SourceSystem& system, const SignedHeat& options) {
  return {!by_gradient(system, options), by_gradient(system, options)};
}

SignedHeatSolver::SignedHeatSolver(std::shared_ptr<const Operators> ops, double time_scale,
                                   Task task, Diffusions diffusions, SolveHint hint)
    : ops_(std::move(ops)),
      hint_(hint),
      order_(
          std::make_shared<const Ordering>(dissection(ops_->scalar.L, task.stage(0.2, "order")))),
      poisson_(std::make_shared<const Poisson>(std::shared_ptr<const SpMat>(ops_, &ops_->scalar.L),
                                               ops_->scalar.component, ops_->scalar.n_components,
                                               task.stage(0.2, "factor Poisson"), *order_,
                                               solver_for(hint))) {
  factor_heat(time_scale, diffusions, task);
}

void SignedHeatSolver::factor_heat(double time_scale, Diffusions diffusions, Task& task) {
  root_t_ = ops_->vector.h * std::sqrt(time_scale);
  const double t = root_t_ * root_t_;
  if (diffusions.scalars)
    scalar_heat_.emplace(ops_->scalar, t, hint_, order_, poisson_->structure(),
                         task.stage(0.2, "factor heat"));
  if (diffusions.vectors)
    heat_.emplace(ops_->vector, t, hint_, order_, task.stage(0.4, "factor vector heat"));
}

SignedHeatSolver SignedHeatSolver::with(double time_scale, Diffusions diffusions, Task task) const {
  SignedHeatSolver out = *this;
  out.heat_.reset();
  out.scalar_heat_.reset();
  out.factor_heat(time_scale, diffusions, task);
  return out;
}

VecX SignedHeatSolver::integrate(const SourceSystem& system, const VecX& b,
                                 const SignedHeat& options, const Task& task,
                                 Report& report) const {
  // Step III: L phi = G^T A Y (eq. 13), subject to the constraints of section 7.1.
  // With points, phi = d0 + psi where d0 is the exact distance next to them: psi has the
  // constraints.
  const Calculus& C = ops_->scalar;
  if (options.soft > 0)
    return poisson_->solve_soft(b, system.A, options.soft * system.weight, task, report,
                                system.value);
  switch (options.constraint) {
    case Constraint::none: {
      VecX phi = poisson_->solve(b, report, task);
      shift_to_mean_zero(C, system, phi);
      return phi;
    }
    case Constraint::zero_set:
      return poisson_->solve_levels(
          b, {system.A, std::vector<int>(system.group.size(), 0), {1}, system.value}, task, report);
    case Constraint::level_sets:
      break;
  }
  LevelRows rows{system.A, system.group, std::vector<int>(system.n_groups, 0)};
  std::vector<char> anchored(C.n_components, 0);
  const Eigen::SparseMatrix<double, Eigen::RowMajor> A = system.A;
  for (int r = 0; r < A.rows(); ++r)
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(A, r); it; ++it) {
      const int c = C.component[it.col()];
      if (c < 0 || anchored[c]) continue;
      anchored[c] = 1;
      rows.anchor[system.group[r]] = 1;
    }
  VecX phi = poisson_->solve_levels(b, rows, task, report);
  shift_to_mean_zero(C, system, phi);
  return phi;
}

VecX SignedHeatSolver::directions(const SourceSystem& system, const SignedHeat& options,
                                  const Task& task, Report& report) const {
  // Steps I and II: X = diffused normals, Y = X / |X|.
  const Calculus& C = ops_->scalar;
  const VectorDiffusion& V = ops_->vector;
  const VecX Y = [&] {
    if (options.preserve_normals)
      return heat_->diffuse_prescribed(V, normalize(system.vectors(V.n)), task, report).Y;
    if (!by_gradient(system, options))
      return heat_->diffuse(V, system.vectors(V.n), task, report).Y;
    CellField X = no_field(C.A.size());
    scalar_heat_->add_nearest(C, system, 1, X, task, report);
    set_near(C, system, X.Y);
    return std::move(X.Y);
  }();
  if (!(Y.cwiseAbs().maxCoeff() > 0))
    report.warn("normals-cancel",
                "the normals of the sources cancel everywhere; the distance is zero");
  return Y;
}

std::vector<char> SignedHeatSolver::reached_pieces(const SourceSystem& system,
                                                   const SignedHeat& options) const {
  const VectorDiffusion& V = ops_->vector;
  const bool vectors = needed_diffusions(system, options).vectors;
  std::vector<char> reached(V.n_pieces, vectors ? 0 : 1);  // scalar heat reaches all
  for (const auto* vectors_of : {&system.X0, &system.X0_points})
    for (const auto& [dof, z] : *vectors_of)
      if (V.piece[dof] >= 0) reached[V.piece[dof]] = 1;
  return reached;
}

VecX SignedHeatSolver::solve(const SourceSystem& system, const SignedHeat& options, Task task,
                             Report& report) const {
  const Diffusions needed = needed_diffusions(system, options);
  if ((needed.vectors && !heat_) || (needed.scalars && !scalar_heat_))
    throw UnsupportedError("signed-heat was not prepared for sources of this kind");
  const Task heat_stage = task.stage(0.5, "diffuse"), poisson_stage = task.stage(0.5, "integrate");

  VecX Y;
  {
    const Stopwatch watch(report, "diffuse");
    Y = directions(system, options, heat_stage, report);
  }
  std::vector<char> reached = reached_pieces(system, options);

  const Stopwatch watch(report, "integrate");
  const bool near = needed.scalars && !system.d0.isZero(0);
  const auto integrated = [&]() -> VecX {
    const Calculus& C = ops_->scalar;
    if (!near) return integrate(system, C.divergence(Y), options, poisson_stage, report);
    constexpr std::size_t number_grain = 1 << 15;
    VecX rest = C.G.apply(system.d0);
    parallel_for(rest.size(), number_grain, [&](std::size_t begin, std::size_t end) {
      for (Eigen::Index k = index(begin); k < index(end); ++k) rest[k] = Y[k] - rest[k];
    });
    return system.d0 + integrate(system, C.divergence(rest), options, poisson_stage, report);
  };
  VecX phi = integrated();
  while (add_across_pinches(phi, reached, Y, poisson_stage, report)) phi = integrated();
  report_gradient(ops_->scalar, phi, Y, report);
  report.sizes.emplace_back("factor_mb", factor_megabytes());
  return finalize_field(*ops_, system, phi, report);
}

double SignedHeatSolver::factor_megabytes() const {
  const double scalar = poisson_->nonzeros() + (scalar_heat_ ? scalar_heat_->nonzeros() : 0);
  const double vector = heat_ ? heat_->nonzeros() : 0;
  return (8 * scalar + (ops_->vector.complex_linear() ? 16 : 8) * vector) / (1 << 20);
}

bool SignedHeatSolver::add_across_pinches(const VecX& phi, std::vector<char>& reached, VecX& Y,
                                          const Task& task, Report& report) const {
  // A piece that hangs on others by single nodes gets no heat through them: it is a problem of its
  // own, with point sources at those nodes, each as strong as its distance makes it and with its
  // sign.
  const VectorDiffusion& V = ops_->vector;
  std::vector<char> node_reached(phi.size(), 0);
  for (const Pinch& pinch : V.pinches)
    if (reached[pinch.piece]) node_reached[pinch.node] = 1;
  std::vector<double> nearest(V.n_pieces, infinity);
  for (const Pinch& pinch : V.pinches)
    if (!reached[pinch.piece] && node_reached[pinch.node])
      nearest[pinch.piece] = std::min(nearest[pinch.piece], std::abs(phi[pinch.node]));
  const auto hangs = [](double d) { return d < infinity; };
  if (std::none_of(nearest.begin(), nearest.end(), hangs)) return false;
  VecX X0 = VecX::Zero(2 * V.n);
  for (const Pinch& pinch : V.pinches) {
    if (reached[pinch.piece] || !node_reached[pinch.node]) continue;
    const double d = phi[pinch.node];
    const double strength = std::exp(-(std::abs(d) - nearest[pinch.piece]) / root_t_);
    for (const auto& [dof, z] : pinch.radial) {
      X0[2 * dof] += std::copysign(strength, d) * z.real();
      X0[2 * dof + 1] += std::copysign(strength, d) * z.imag();
    }
  }
  for (int p = 0; p < V.n_pieces; ++p)
    if (hangs(nearest[p])) reached[p] = 1;
  const CellField beyond = heat_->diffuse(V, std::move(X0), task, report);
  for (Eigen::Index c = 0; c < beyond.log_length.size(); ++c)
    if (std::isfinite(beyond.log_length[c])) Y.segment<2>(2 * c) = beyond.Y.segment<2>(2 * c);
  return true;
}

}  // namespace littoral
