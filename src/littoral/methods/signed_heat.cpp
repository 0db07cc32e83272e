#include "littoral/methods/signed_heat.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "littoral/methods/shift.h"

namespace littoral {

const OptionTable<SignedHeatOptions>& signed_heat_options() {
  using O = SignedHeatOptions;
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
                  "Holds the diffused vectors at the source's own normals.");
  return table;
}

double automatic_time_scale(const SourceTerms& terms) { return terms.only_points ? 16 : 1; }

SignedHeat::SignedHeat(std::shared_ptr<const Operators> ops, double time_scale, Task task)
    : ops_(std::move(ops)),
      heat_(ops_->vector, time_scale * ops_->vector.h * ops_->vector.h,
            task.stage(0.75, "factor heat")),
      poisson_(ops_->scalar.L, ops_->scalar.component, ops_->scalar.n_components,
               task.stage(0.25, "factor Poisson")) {}

VecX SignedHeat::integrate(const SourceTerms& terms, const VecX& Y,
                           const SignedHeatOptions& options, const Task& task,
                           Report& report) const {
  // Step III: L phi = G^T A Y (eq. 13), subject to the constraints of section 7.1.
  const Calculus& C = ops_->scalar;
  const VecX b = C.divergence(Y);
  if (options.soft > 0)
    return poisson_.solve_soft(b, terms.A, options.soft * terms.weight, task, report);
  switch (static_cast<Constraint>(options.constraint)) {
    case Constraint::none: {
      VecX phi = poisson_.solve(b, report);
      shift_to_mean_zero(C, terms, phi);
      return phi;
    }
    case Constraint::zero_set:
      return poisson_.solve_levels(b, {terms.A, std::vector<int>(terms.group.size(), 0), {1}}, task,
                                   report);
    case Constraint::level_sets:
      break;
  }
  LevelRows rows{terms.A, terms.group, std::vector<int>(terms.n_groups, 0)};
  std::vector<char> anchored(C.n_components, 0);
  const Eigen::SparseMatrix<double, Eigen::RowMajor> A = terms.A;
  for (int r = 0; r < A.rows(); ++r)
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(A, r); it; ++it) {
      const int c = C.component[it.col()];
      if (c < 0 || anchored[c]) continue;
      anchored[c] = 1;
      rows.anchor[terms.group[r]] = 1;
    }
  VecX phi = poisson_.solve_levels(b, rows, task, report);
  shift_to_mean_zero(C, terms, phi);
  return phi;
}

VecX SignedHeat::solve(const SourceTerms& terms, const SignedHeatOptions& options, Task task,
                       Report& report) const {
  const VectorDiffusion& V = ops_->vector;
  const double root_t =
      V.h * std::sqrt(options.time_scale > 0 ? options.time_scale : automatic_time_scale(terms));
  const Task heat_stage = task.stage(0.5, "diffuse"), poisson_stage = task.stage(0.5, "integrate");

  // Steps I and II: X = diffused normals, Y = X / |X|.
  VecX X;
  {
    const Stopwatch watch(report, "diffuse");
    X = options.preserve_normals ? diffuse_preserving(terms, heat_stage, report)
                                 : heat_.diffuse(V, terms.X0, heat_stage, report);
  }
  std::vector<char> reached(V.n_pieces, 0);
  for (int i = 0; i < V.n; ++i)
    if (V.piece[i] >= 0 && (terms.X0[2 * i] != 0 || terms.X0[2 * i + 1] != 0))
      reached[V.piece[i]] = 1;
  if (std::find(reached.begin(), reached.end(), 1) == reached.end())
    report.warn("the normals of the sources cancel everywhere; the distance is zero");

  const Stopwatch watch(report, "integrate");
  int zeros = 0;
  VecX phi = integrate(terms, normalize(X, zeros), options, poisson_stage, report);
  while (add_across_pinches(phi, root_t, reached, X, poisson_stage, report))
    phi = integrate(terms, normalize(X, zeros), options, poisson_stage, report);
  return finish_field(*ops_, terms, phi, report);
}

VecX SignedHeat::diffuse_preserving(const SourceTerms& terms, const Task& task,
                                    Report& report) const {
  int zeros = 0;
  return heat_.diffuse_held(ops_->vector, normalize(terms.X0, zeros), task, report);
}

bool SignedHeat::add_across_pinches(const VecX& phi, double root_t, std::vector<char>& reached,
                                    VecX& X, const Task& task, Report& report) const {
  // A piece that hangs on others by single nodes gets no heat through them: it is a problem of its
  // own, with point sources at those nodes, each as strong as its distance makes it and with its
  // sign.
  const VectorDiffusion& V = ops_->vector;
  std::vector<char> node_reached(static_cast<std::size_t>(phi.size()), 0);
  for (const Pinch& pinch : V.pinches)
    if (reached[pinch.piece]) node_reached[pinch.node] = 1;
  std::vector<double> nearest(V.n_pieces, std::numeric_limits<double>::infinity());
  for (const Pinch& pinch : V.pinches)
    if (!reached[pinch.piece] && node_reached[pinch.node])
      nearest[pinch.piece] = std::min(nearest[pinch.piece], std::abs(phi[pinch.node]));
  VecX X0 = VecX::Zero(2 * V.n);
  for (const Pinch& pinch : V.pinches) {
    if (reached[pinch.piece] || !node_reached[pinch.node]) continue;
    const double d = phi[pinch.node];
    const double strength = std::exp(-(std::abs(d) - nearest[pinch.piece]) / root_t);
    for (const auto& [carrier, z] : pinch.radial) {
      X0[2 * carrier] += std::copysign(strength, d) * z.real();
      X0[2 * carrier + 1] += std::copysign(strength, d) * z.imag();
    }
  }
  bool any = false;
  for (int p = 0; p < V.n_pieces; ++p) {
    if (!std::isfinite(nearest[p])) continue;
    reached[p] = 1;
    any = true;
  }
  if (any) X += heat_.diffuse(V, X0, task, report);  // zero on all other pieces
  return any;
}

}  // namespace littoral
