#include "methods/regularized/regularized.h"

#include <algorithm>
#include <cmath>

#include "littoral/error.h"
#include "methods/heat/finalize.h"
#include "solve/optimization/gradient_energy.h"

namespace littoral {

namespace {

constexpr int most_iterations = 1'000'000'000;

template <class S>
OptionTable<S> with_alpha(OptionTable<S> table) {
  return table.number(
      &S::alpha, "alpha", "", 0, 1e6,
      "Smoothing, whatever the size of the domain (alpha-hat); 0 gives the distance "
      "of Belyaev and Fayolle.");
}

/// When to stop.
template <class S>
OptionTable<S> with_stopping(OptionTable<S> table) {
  return table
      .number(&S::tolerance, "tolerance", "", 1e-10, 1,
              "Iterations stop when both residuals are below this share of what they compare.")
      .number(&S::gap, "gap", "", 0, 1,
              "If not 0, iterations go on until the duality gap is below this share of the "
              "objective.")
      .integer(&S::max_iterations, "max-iterations", "", 1, most_iterations,
               "Iterations after which the best answer so far is given.");
}

/// On which functions.
template <class S>
OptionTable<S> with_elements(OptionTable<S> table) {
  return table
      .choice(
          &S::elements, "elements", {"linear", "quadratic"},
          "Functions on triangles: linear, or quadratic, which bend inside them and are rounder "
          "near the source (Dirichlet energy and no energy; triangle meshes).")
      .integer(&S::subdivide, "subdivide", "", 1, 64,
               "Write and draw a mesh with every side cut into this many parts (quadratic).");
}

}  // namespace

const OptionTable<Regularized>& regularized_options() {
  using O = Regularized;
  static const OptionTable<O> table = with_elements(with_stopping(
      with_alpha(OptionTable<O>())
          .choice(
              &O::regularizer, "regularizer", {"dirichlet", "hessian", "align", "max-norm"},
              "What is smooth: small gradients, small second derivatives (unaffected by "
              "boundaries), gradients across the field, small largest coordinate of the gradient.")
          .number(&O::beta, "beta", "", 0, 1e9, "Weight of alignment against smoothness (align).")
          .text(&O::field, "field", "FILE",
                "Directions to align with (align): lines `x y z`, one for each face, or `f I x y "
                "z`, interpolated.")
          .number(&O::field_width, "field-width", "square root of the area", 0, 1e6,
                  "If not 0, interpolated directions fade away from the given ones like a Gaussian "
                  "of this width.")));
  return table;
}

const OptionTable<BelyaevFayolle>& belyaev_fayolle_options() {
  static const auto table = with_elements(with_stopping(OptionTable<BelyaevFayolle>()));
  return table;
}

const OptionTable<SpaceRegularized>& space_regularized_options() {
  static const auto table = with_stopping(with_alpha(OptionTable<SpaceRegularized>()));
  return table;
}

const OptionTable<SpaceBelyaevFayolle>& space_belyaev_fayolle_options() {
  static const auto table = with_stopping(OptionTable<SpaceBelyaevFayolle>());
  return table;
}

namespace {

/// alpha of eq. 11 from alpha-hat (7.1); in space alpha, a length, scales with the cube root of the
/// volume.
double alpha_of(const Regularized& options, Regularizer regularizer, double measure, int dim) {
  const double root = std::pow(measure, 1.0 / dim);
  return options.alpha * (regularizer == Regularizer::hessian ? root * root * root : root);
}

/// The part of the objective that is a function of each cell's gradient, with |grad u| <= 1.
std::unique_ptr<GradientEnergy> cell_energy(Regularizer regularizer, const RegularizerData& data,
                                            double alpha, double beta, int dim) {
  switch (regularizer) {
    case Regularizer::align:
      return std::make_unique<BallQuadraticEnergy>(dim, alpha, alpha * beta, data.V);
    case Regularizer::max_norm:
      return std::make_unique<BallMaxNormEnergy>(alpha, data.frames);
    case Regularizer::dirichlet:
    case Regularizer::hessian:
      break;
  }
  return std::make_unique<BallQuadraticEnergy>(dim, 0, 0, VecX());
}

VecX times(const SpMat& lower, const VecX& x) { return lower.selfadjointView<Eigen::Lower>() * x; }

}  // namespace

RegularizedSolver::RegularizedSolver(std::shared_ptr<const Operators> ops, Regularizer regularizer,
                                     RegularizerData data, const Task& task,
                                     ConstrainedSystem::Rows expected)
    : ops_(std::move(ops)),
      regularizer_(regularizer),
      data_(std::make_shared<const RegularizerData>(std::move(data))) {
  const Calculus& C = ops_->scalar;
  if (regularizer == Regularizer::align && data_->V.size() != C.G.rows)
    throw InputError(
        "aligned distance needs one direction per face: option field names a file of them");
  if (regularizer == Regularizer::align && !data_->V.allFinite())
    throw InputError("a direction of the field is not finite");
  if (regularizer == Regularizer::max_norm && data_->frames.rows() != C.G.rows)
    throw UnsupportedError("the max-norm regularizer needs faces in space");
  if (regularizer == Regularizer::hessian) {
    if (data_->W.rows() != C.L.rows())
      throw UnsupportedError("the Hessian regularizer needs a triangle mesh");
    return;  // nothing to factor before rho is known
  }
  laplacian_ =
      std::make_shared<const ConstrainedSystem>(C.L, C.component, C.n_components, task, expected);
}

AdmmResult RegularizedSolver::minimize(const SpMat& rows, const Regularized& options,
                                       AdmmState& state, const Task& task, const VecX* sign) const {
  const Calculus& C = ops_->scalar;
  std::vector<char> active(C.n_components, 0);
  for (int j = 0; j < rows.outerSize(); ++j)
    for (SpMat::InnerIterator it(rows, j); it; ++it)
      if (C.component[it.col()] >= 0) active[C.component[it.col()]] = 1;
  double area = 0;
  SplitProblem problem;
  problem.b = C.M;  // A_V
  for (Eigen::Index i = 0; i < C.M.size(); ++i) {
    const int c = C.component[i];
    if (c < 0 || !active[c]) problem.b[i] = 0;
    area += problem.b[i];
  }
  if (sign) problem.b = problem.b.cwiseProduct(*sign);
  const int dim = C.G.rows / C.A.size();
  const double alpha = alpha_of(options, regularizer_, area, dim);
  const auto energy = cell_energy(regularizer_, *data_, alpha, options.beta, dim);
  problem.A = C.A;
  problem.dim = dim;
  problem.energy = energy.get();
  problem.G = C.G.matrix();

  AdmmOptions admm_options;
  admm_options.relative = options.tolerance;
  admm_options.absolute = std::min(5e-6, 5e-4 * options.tolerance);
  admm_options.gap = options.gap;
  admm_options.max_iterations = options.max_iterations;

  ConstrainedSystem::Constrained constrained;
  double constrained_rho = -1;  // Hessian: the penalty for which `constrained` was factored
  if (regularizer_ == Regularizer::hessian) {
    const SpMat& W = data_->W;
    problem.quadratic = [&W, alpha](const VecX& u) { return VecX(alpha * times(W, u)); };
    problem.solve = [&](const VecX& b, double rho) {
      if (rho != constrained_rho) {
        constrained = ConstrainedSystem(SpMat(alpha * W + rho * C.L), C.component, C.n_components,
                                        task, ConstrainedSystem::Rows::many)
                          .constrain(rows, task);
        constrained_rho = rho;
      }
      return constrained.solve(b);
    };
    admm_options.penalty_changes = 8;
  } else if (regularizer_ == Regularizer::dirichlet) {
    // Alg. 1: alpha W + rho W_D = (alpha + rho) W_D, so the factor of W_D serves every penalty.
    constrained = laplacian_->constrain(rows, task);
    if (alpha > 0)
      problem.quadratic = [&C, alpha](const VecX& u) { return VecX(alpha * times(C.L, u)); };
    problem.solve = [&constrained, alpha](const VecX& b, double rho) {
      return VecX(constrained.solve(b) / (alpha + rho));
    };
  } else {
    constrained = laplacian_->constrain(rows, task);
    problem.solve = [&constrained](const VecX& b, double rho) {
      return VecX(constrained.solve(b) / rho);
    };
  }
  return admm(problem, admm_options, state, task);
}

VecX RegularizedSolver::solve(const SourceSystem& system, const Regularized& options,
                              const Task& task, Report& report, AdmmState* state) const {
  AdmmState own;
  const AdmmResult result = minimize(system.A, options, state ? *state : own, task);
  report_admm(result, report);
  return finalize_field(*ops_, system, result.u.cwiseMax(0.0), report);
}

}  // namespace littoral
