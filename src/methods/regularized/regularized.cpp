#include "methods/regularized/regularized.h"

#include <algorithm>
#include <cmath>

#include "methods/heat/finalize.h"

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
              "Iterations stop when both residuals are below this share of what they compare, and "
              "the duality gap below ten times it.")
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
      .choice(&S::triangulation, "triangulation", {"auto", "as-is", "delaunay"},
              "Functions are linear on the given triangles, or on intrinsic Delaunay ones with the "
              "same vertices; auto takes these where more than 7.5 % of the edges are not Delaunay "
              "(linear elements, Dirichlet energy and no energy; triangle meshes).")
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

RegularizedSolver::RegularizedSolver(std::shared_ptr<const Operators> ops, Regularizer regularizer,
                                     RegularizerData data, const Task& task, SolveHint hint,
                                     ConstrainedSystem::Rows expected)
    : ops_(std::move(ops)),
      parts_(regularized_parts(std::shared_ptr<const Calculus>(ops_, &ops_->scalar), regularizer,
                               std::move(data), expected)) {
  if (parts_.size() == 1 && hint == SolveHint::many_rhs) parts_[0].order(task);
}

AdmmResult RegularizedSolver::minimize(const KnownDistances& known, const Regularized& options,
                                       AdmmState& state, const Task& task, const VecX* sign) const {
  if (parts_.size() == 1) return parts_[0].minimize(known, options, state, task, sign);
  const Calculus& C = ops_->scalar;
  std::vector<KnownDistances> known_in(parts_.size());  // by the parts' own nodes
  for (const auto& [i, distance] : known)
    if (const int c = C.component[i]; c >= 0) {
      const std::vector<int>& nodes = parts_[c].nodes;
      const auto at = std::lower_bound(nodes.begin(), nodes.end(), i) - nodes.begin();
      known_in[c].emplace(at, distance);
    }
  double nodes = 0;
  for (std::size_t c = 0; c < parts_.size(); ++c)
    if (!known_in[c].empty()) nodes += static_cast<double>(parts_[c].nodes.size());
  state.parts.resize(parts_.size());
  AdmmResult all;
  all.converged = true;
  all.u = VecX::Zero(C.M.size());
  Task rest = task;
  for (std::size_t c = 0; c < parts_.size(); ++c) {
    if (known_in[c].empty()) continue;
    const std::vector<int>& of_all = parts_[c].nodes;
    const VecX sign_here = sign ? VecX((*sign)(of_all)) : VecX();
    const Task stage =
        rest.stage(static_cast<double>(of_all.size()) / nodes, "alternating directions");
    AdmmResult one = parts_[c].minimize(known_in[c], options, state.parts[c], stage,
                                        sign ? &sign_here : nullptr);
    for (std::size_t i = 0; i < of_all.size(); ++i) all.u[of_all[i]] = one.u[i];
    all.objective += one.objective;
    all.gap = std::max(all.gap, one.gap);
    all.primal = std::max(all.primal, one.primal);
    all.dual = std::max(all.dual, one.dual);
    all.largest = std::max(all.largest, one.largest);
    all.convexified = std::max(all.convexified, one.convexified);
    all.iterations += one.iterations;
    all.converged = all.converged && one.converged;
    one.u = VecX();
    one.component = c;
    all.parts.push_back(std::move(one));
  }
  return all;
}

std::vector<char> RegularizedSolver::reached(const KnownDistances& known) const {
  const Calculus& C = ops_->scalar;
  std::vector<char> reached(C.n_components, 0);
  for (const auto& [i, distance] : known)
    if (C.component[i] >= 0) reached[C.component[i]] = 1;
  return reached;
}

VecX RegularizedSolver::solve(const KnownDistances& known, const Regularized& options,
                              const Task& task, Report& report, AdmmState* state) const {
  AdmmState own;
  const AdmmResult result = minimize(known, options, state ? *state : own, task);
  report_admm(result, report);
  if (result.convexified > 0)
    report.warn("curvature-raised",
                "the Hessian energy is negative for functions that bend with saddles of the "
                "surface, and option alpha so large that it has no least value: " +
                    rounded_text(result.convexified / (ops_->unit * ops_->unit)) +
                    " was added to the Gaussian curvature");
  return finalize_field(ops_->scalar.component, ops_->scalar.n_components, ops_->unit,
                        reached(known), result.u.cwiseMax(0.0), report);
}

}  // namespace littoral
