#include "methods/heat/signed_heat_tets.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "methods/heat/finalize.h"
#include "solve/direct/cholesky.h"
#include "solve/heat/outward_sweeps.h"
#include "solve/poisson/constrained_poisson.h"
#include "solve/poisson/poisson.h"

namespace littoral {

namespace {

constexpr int quick_to_factor = 20'000;  // faces
constexpr double point_time = 4;         // around points, in units of the time elsewhere
constexpr int most_sets = 8;             // of values that are diffused together
constexpr double widest_set = 300;       // their range in decay lengths: exp(-300) is a number

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

/// Values in ascending order whose sources are diffused in one solve. Each value by itself takes
/// directions from the strongest source alone; what is summed takes a mean of them where two are as
/// strong. So the first few are apart, and neighbours among more: one solve for each of as many
/// sets, and more only where values of one are too far apart for one range of numbers.
std::vector<std::vector<double>> diffused_together(const VecX& values, double root_t) {
  const std::set<double> all(values.begin(), values.end());
  std::vector<std::vector<double>> sets(std::min<std::size_t>(most_sets, all.size()));
  std::size_t rank = 0;
  for (const double c : all) sets[rank++ % sets.size()].push_back(c);
  std::vector<std::vector<double>> out;
  for (const std::vector<double>& set : sets)
    for (const double c : set) {
      if (c == set.front() || c - out.back().front() > widest_set * root_t) out.emplace_back();
      out.back().push_back(c);
    }
  return out;
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
    const auto heat = [&] { return SpMat(ops.face_mass + t * ops.face_laplacian); };
    std::optional<MatX3> X;
    if (hint_ == SolveHint::single_rhs && ops.n_faces > quick_to_factor)
      X = solve_by_outward_sweeps(heat(), system.X0, heat_stage);
    if (!X)
      X = faces_.get(t, [&] { return Cholesky<double>(heat(), heat_stage); })->solve(system.X0);
    // Step II: Y = X / |X| on tets (B.2).
    int zeros = 0;
    Y = normalize_rows(ops.to_tets(*X), ops.volumes, zeros);
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
    // Step II: Y = -grad u / |grad u| of the sources that are strongest, weakened by
    // exp(-value / sqrt(t)).
    int zeros = 0;
    VecX strongest = VecX::Constant(ops.volumes.size(), -infinity);
    MatX3 X = MatX3::Zero(ops.volumes.size(), 3);
    const auto sets = diffused_together(system.value, std::sqrt(t));
    report.iterations.emplace_back("heat solves", sets.size());
    for (const std::vector<double>& together : sets) {
      heat_stage.checkpoint();  // each takes a solve
      VecX own = VecX::Zero(system.value.size());
      for (Eigen::Index r = 0; r < own.size(); ++r)
        if (std::binary_search(together.begin(), together.end(), system.value[r]))
          own[r] = std::exp((together.front() - system.value[r]) / std::sqrt(t));
      const MatX3 slope = ops.gradient(factor->solve(VecX(system.A.transpose() * own)));
      for (Eigen::Index i = 0; i < X.rows(); ++i) {
        const double strength =
            std::log(slope.row(i).stableNorm()) - together.front() / std::sqrt(t);
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
