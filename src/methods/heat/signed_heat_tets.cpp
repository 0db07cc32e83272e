#include "methods/heat/signed_heat_tets.h"

#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "methods/heat/finalize.h"
#include "solve/direct/cholesky.h"
#include "solve/poisson/constrained_poisson.h"
#include "solve/poisson/poisson.h"

namespace littoral {

namespace {

constexpr double point_time = 4;  // around points, in units of the time elsewhere

/// Step II, one vector a tet; zeros in tets of some volume are counted.
MatX3 normalize_rows(MatX3 X, const VecX& volumes, int& zeros) {
  for (Eigen::Index t = 0; t < X.rows(); ++t) {
    auto x = X.row(t);
    const double size = x.stableNorm();
    if (size > 0 && std::isfinite(size)) {
      x /= size;
    } else {
      x.setZero();
      if (volumes[t] > 0) ++zeros;
    }
  }
  return X;
}

}  // namespace

/// Step III: L phi = G^T A Y, held at the sources.
VecX TetHeatSolver::integrate(const TetSourceSystem& system, const MatX3& Y, double h,
                              double tolerance, const SpaceSignedHeat& options, Task task,
                              Report& report) const {
  const Task factor_stage = task.stage(0.7, "factoring");
  const Task constrain_stage = task.stage(0.3, "integrating");
  const Stopwatch watch(report, "integrate");
  const TetOperators& ops = *ops_;
  const auto factored =
      poisson_.get([&] { return Poisson(ops.L, ops.component, ops.n_components, factor_stage); });
  const Poisson& poisson = *factored;
  VecX phi = poisson.solve(ops.divergence(Y), report);
  std::vector<char> reached(ops.n_components, 0);
  for (int v = 0; v < system.A.outerSize(); ++v)
    if (SpMat::InnerIterator(system.A, v) && ops.component[v] >= 0) reached[ops.component[v]] = 1;

  const auto constraint = options.constraint;
  if (system.A.rows() > 0 && constraint != SpaceConstraint::none) {
    HeldRows held = held_rows(options, system.weight, h, system.part);
    phi = solve_constrained(
        [&](VecX& b) {
          Report ignored;
          b = poisson.solve(b, ignored);
        },
        std::move(phi),
        {system.A, std::move(held.softness), tolerance, std::move(held.group), system.value},
        constrain_stage, report);
  }
  if (system.A.rows() > 0 &&
      (constraint == SpaceConstraint::none || constraint == SpaceConstraint::level_sets))
    phi.array() -= system.weight.dot(system.A * phi - system.value) / system.weight.sum();
  set_unreached(phi, ops.component, reached, report);
  return phi;
}

VecX TetHeatSolver::signed_distance(const TetSourceSystem& system, double h, double tolerance,
                                    const SpaceSignedHeat& options, Task task,
                                    Report& report) const {
  const TetOperators& ops = *ops_;
  const Task heat_stage = task.stage(0.7, "diffusing normals");
  const Task integrate_stage = task.stage(0.3, "integrating");

  // Step I: (M + t L) X = X0 on faces; space is flat, so componentwise.
  MatX3 Y;
  {
    const Stopwatch watch(report, "diffuse");
    const FlushSubnormals flush;
    const double t = options.time_scale * h * h;
    const auto factor = faces_.get(t, [&] {
      return Cholesky<double>(SpMat(ops.face_mass + t * ops.face_laplacian), heat_stage);
    });
    const MatX3 X = factor->solve(system.X0);
    // Step II: Y = X / |X| on tets (B.2).
    int zeros = 0;
    Y = normalize_rows(ops.to_tets(X), ops.volumes, zeros);
    if (zeros > 0)
      report.warn("direction-missing",
                  counted(zeros, "tet is", "tets are") +
                      " too far from the input for heat to reach: distances are less exact there. "
                      "A larger option time-scale reaches farther");
  }
  return integrate(system, Y, h, tolerance, options, integrate_stage, report);
}

VecX TetHeatSolver::unsigned_distance(const TetSourceSystem& system, double h, double tolerance,
                                      const SpaceSignedHeat& options, Task task,
                                      Report& report) const {
  const TetOperators& ops = *ops_;
  const Task heat_stage = task.stage(0.5, "diffusing");
  const Task integrate_stage = task.stage(0.5, "integrating");
  MatX3 Y;
  {
    const Stopwatch watch(report, "diffuse");
    const FlushSubnormals flush;
    // Step I: (M + t L) u = sum of the sources.
    const double t = point_time * options.time_scale * h * h;
    VecX mass = ops.vertex_mass();
    for (Eigen::Index v = 0; v < mass.size(); ++v)  // those of no tet: an equation of their own
      if (ops.component[v] < 0) mass[v] = 1;
    const auto factor = vertices_.get(t, [&] {
      return Cholesky<double>(SpMat(t * ops.L + SpMat(mass.asDiagonal())), heat_stage);
    });
    // Step II: Y = -grad u / |grad u| of the sources of one value that are strongest, weakened by
    // exp(-value / sqrt(t)).
    int zeros = 0;
    VecX strongest = VecX::Constant(ops.volumes.size(), -infinity);
    MatX3 X = MatX3::Zero(ops.volumes.size(), 3);
    for (const double value : std::set<double>(system.value.begin(), system.value.end())) {
      heat_stage.checkpoint();  // each value takes a solve
      const VecX own = (system.value.array() == value).cast<double>();
      const MatX3 slope = ops.gradient(factor->solve(VecX(system.A.transpose() * own)));
      for (Eigen::Index i = 0; i < X.rows(); ++i) {
        const double strength = std::log(slope.row(i).stableNorm()) - value / std::sqrt(t);
        if (!(strength > strongest[i])) continue;
        strongest[i] = strength;
        X.row(i) = -slope.row(i);
      }
    }
    Y = normalize_rows(std::move(X), ops.volumes, zeros);
    if (zeros > 0)
      report.warn("direction-missing",
                  counted(zeros, "tet is", "tets are") +
                      " too far from the sources for heat to reach: distances are less exact "
                      "there. A larger option time-scale reaches farther");
  }
  return integrate(system, Y, h, tolerance, options, integrate_stage, report);
}

}  // namespace littoral
