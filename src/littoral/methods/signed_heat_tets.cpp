#include "littoral/methods/signed_heat_tets.h"

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "littoral/base/parallel.h"
#include "littoral/solve/cholesky.h"
#include "littoral/solve/held_poisson.h"
#include "littoral/solve/poisson.h"

namespace littoral {

namespace {

/// Step II, one vector a tet; the zeros are counted.
MatX3 normalize_rows(MatX3 X, int& zeros) {
  for (auto x : X.rowwise()) {
    const double size = x.stableNorm();
    if (size > 0 && std::isfinite(size)) {
      x /= size;
    } else {
      x.setZero();
      ++zeros;
    }
  }
  return X;
}

}  // namespace

VecX signed_heat_tets(const TetOperators& ops, const TetSourceTerms& terms, double h,
                      double tolerance, const SpaceHeatOptions& options, Task task,
                      Report& report) {
  const Task heat_stage = task.stage(0.7, "diffusing normals");
  const Task factor_stage = task.stage(0.2, "factoring");
  const Task hold_stage = task.stage(0.1, "integrating");

  // Step I: (M + t L) X = X0 on faces; space is flat, so componentwise.
  MatX3 Y;
  {
    const Stopwatch watch(report, "diffuse");
    const FlushSubnormals flush;
    const double t = options.time_scale * h * h;
    const SpMat A = ops.face_mass + t * ops.face_laplacian;
    const Cholesky<double> factor(A, heat_stage);
    const MatX3 X = factor.solve(terms.X0);
    // Step II: Y = X / |X| on tets (B.2).
    int zeros = 0;
    Y = normalize_rows(ops.to_tets(X), zeros);
    if (zeros > 0)
      report.warn(std::to_string(zeros) + " tets have no direction: too far from the input");
  }

  // Step III: L phi = G^T A Y.
  const Stopwatch watch(report, "integrate");
  const Poisson poisson(ops.L, ops.component, ops.n_components, factor_stage);
  VecX phi = poisson.solve(ops.divergence(Y), report);
  std::vector<char> reached(static_cast<std::size_t>(ops.n_components), 0);
  for (int v = 0; v < terms.A.outerSize(); ++v)
    if (SpMat::InnerIterator(terms.A, v) && ops.component[static_cast<std::size_t>(v)] >= 0)
      reached[static_cast<std::size_t>(ops.component[static_cast<std::size_t>(v)])] = 1;

  const auto constraint = static_cast<SpaceConstraint>(options.constraint);
  if (terms.A.rows() > 0 && constraint != SpaceConstraint::none) {
    VecX softness = VecX::Zero(terms.A.rows());
    if (constraint == SpaceConstraint::soft) softness = h / (options.soft * terms.weight.array());
    phi = solve_held(
        [&](VecX& b) {
          Report ignored;
          b = poisson.solve(b, ignored);
        },
        std::move(phi), {terms.A, softness, tolerance}, hold_stage, report);
  } else if (terms.A.rows() > 0) {
    phi.array() -= terms.weight.dot(terms.A * phi) / terms.weight.sum();
  }
  for (Eigen::Index v = 0; v < phi.size(); ++v) {
    const int c = ops.component[static_cast<std::size_t>(v)];
    if (c < 0 || reached[static_cast<std::size_t>(c)] == 0)
      phi[v] = std::numeric_limits<double>::infinity();
  }
  for (int c = 0; c < ops.n_components; ++c)
    if (reached[static_cast<std::size_t>(c)] == 0) report.unreachable_components.push_back(c);
  return phi;
}

}  // namespace littoral
