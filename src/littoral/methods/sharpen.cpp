#include "littoral/methods/sharpen.h"

#include <cmath>

#include "littoral/solve/admm.h"
#include "littoral/solve/definite.h"
#include "littoral/solve/pdhg.h"

namespace littoral {

namespace {

/// Constraints on one number a cell after the cells of the gradient, in its first coordinate: at
/// first nodes that keep their sign, then rows that vanish.
class SignedBall : public CellEnergy {
 public:
  SignedBall(int dim, Eigen::Index cells, std::vector<int> sign)
      : dim_(dim), cells_(cells), sign_(std::move(sign)) {}

  void prox(Eigen::Index cell, double, const double* w, double* z) const override {
    if (cell < cells_) {
      double length2 = 0;
      for (int d = 0; d < dim_; ++d) length2 += w[d] * w[d];
      const double shrink = 1 / std::sqrt(std::max(1.0, length2));
      for (int d = 0; d < dim_; ++d) z[d] = shrink * w[d];
      return;
    }
    for (int d = 1; d < dim_; ++d) z[d] = 0;
    const int sign = sign_of(cell);
    z[0] = sign * std::max(0.0, sign * w[0]);
  }
  double value(Eigen::Index, const double*) const override { return 0; }
  double conjugate(Eigen::Index cell, const double* y) const override {
    return cell < cells_ ? Eigen::Map<const VecX>(y, dim_).norm() : 0;
  }
  double gauge(Eigen::Index cell, const double* z) const override {
    return cell < cells_ ? Eigen::Map<const VecX>(z, dim_).norm() : 0;
  }

 private:
  int sign_of(Eigen::Index cell) const {  // 0: must vanish
    const auto i = static_cast<std::size_t>(cell - cells_);
    return i < sign_.size() ? sign_[i] : 0;
  }
  int dim_;
  Eigen::Index cells_;
  std::vector<int> sign_;
};

int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Signs of phi0 on the components that count, 0 at the source.
std::vector<int> signs_of(const Calculus& C, const std::vector<char>& reached, const VecX& phi0) {
  double largest = 0;
  for (const double x : phi0)
    if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
  std::vector<int> out(static_cast<std::size_t>(phi0.size()), 0);
  for (Eigen::Index i = 0; i < phi0.size(); ++i) {
    const int c = C.component[i];
    if (c >= 0 && reached[c] && std::abs(phi0[i]) > 1e-9 * largest) out[i] = sign(phi0[i]);
  }
  return out;
}

/// Nodes next to one of another sign, by the pattern of L.
std::vector<int> band_of(const SpMat& L, const std::vector<int>& s) {
  std::vector<char> near(s.size(), 0);
  for (int j = 0; j < L.outerSize(); ++j)
    for (SpMat::InnerIterator it(L, j); it; ++it)
      if (s[it.row()] != s[j]) near[it.row()] = near[j] = 1;
  std::vector<int> band;
  for (std::size_t i = 0; i < s.size(); ++i)
    if (near[i]) band.push_back(static_cast<int>(i));
  return band;
}

/// G, and below it each row of R as the first of `dim` rows.
SpRows stacked(const SpRows& G, const SpMat& R, int dim) {
  Triplets entries;
  entries.reserve(static_cast<std::size_t>(G.nonZeros() + R.nonZeros()));
  for (int r = 0; r < G.outerSize(); ++r)
    for (SpRows::InnerIterator it(G, r); it; ++it)
      entries.emplace_back(r, static_cast<int>(it.col()), it.value());
  for (int j = 0; j < R.outerSize(); ++j)
    for (SpMat::InnerIterator it(R, j); it; ++it)
      entries.emplace_back(static_cast<int>(G.rows()) + dim * static_cast<int>(it.row()), j,
                           it.value());
  SpRows both(G.rows() + dim * R.rows(), G.cols());
  both.setFromTriplets(entries.begin(), entries.end());
  return both;
}

}  // namespace

VecX sharpen(const Operators& ops, const SourceTerms& terms, const VecX& phi0,
             const SharpenOptions& options, const Task& task, Report& report) {
  const Calculus& C = ops.scalar;
  const Stopwatch watch(report, "sharpen");
  const Eigen::Index n = C.M.size(), cells = C.A.size();
  const int dim = static_cast<int>(C.G.rows / cells);
  const std::vector<int> s = signs_of(C, terms.reached, phi0), band = band_of(C.L, s);

  // The rows after the gradient: values at nodes of the band and at the source, over h.
  Triplets entries;
  std::vector<int> band_sign;
  std::vector<double> weight;
  for (const int i : band) {
    entries.emplace_back(static_cast<int>(band_sign.size()), i, 1 / C.h);
    band_sign.push_back(s[i]);
    weight.push_back(C.M[i]);
  }
  const auto first_row = static_cast<int>(band_sign.size());
  for (int j = 0; j < terms.A.outerSize(); ++j)
    for (SpMat::InnerIterator it(terms.A, j); it; ++it)
      entries.emplace_back(first_row + static_cast<int>(it.row()), static_cast<int>(it.col()),
                           it.value() / C.h);
  for (Eigen::Index r = 0; r < terms.A.rows(); ++r) weight.push_back(10 * std::pow(C.h, dim));
  const auto extra = static_cast<Eigen::Index>(weight.size());
  SpMat R(extra, n);
  R.setFromTriplets(entries.begin(), entries.end());
  const VecX w = Eigen::Map<const VecX>(weight.data(), extra);

  SplitProblem problem;
  problem.dim = dim;
  problem.A.resize(cells + extra);
  problem.A << C.A, w;
  problem.b = VecX::Zero(n);
  std::vector<char> gone(static_cast<std::size_t>(n), 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    problem.b[i] = s[i] * C.M[i];
    const int c = C.component[i];
    gone[i] = c < 0 || !terms.reached[c];
  }
  const SignedBall energy(dim, cells, band_sign);
  problem.energy = &energy;
  problem.G = stacked(C.G.matrix(), R, dim);
  VecX start(n);
  for (Eigen::Index i = 0; i < n; ++i) start[i] = gone[i] ? 0 : phi0[i] / ops.unit;

  AdmmState state;
  multiply(problem.G, start, state.z, task);
  for (Eigen::Index c = 0; c < cells + extra; ++c) {
    const VecX given = state.z.segment(dim * c, dim);
    energy.prox(c, 1, given.data(), state.z.data() + dim * c);
  }
  state.w = VecX::Zero(state.z.size());
  state.rho = 2 * std::sqrt(problem.A.sum());
  AdmmOptions admm_options;
  admm_options.relative = options.tolerance;
  admm_options.absolute = std::min(5e-6, 5e-4 * options.tolerance);
  admm_options.max_iterations = options.max_iterations;
  AdmmResult result;
  if (options.solver == SharpenSolver::pdhg) {
    result = pdhg(problem, C.M, start, admm_options, task);
  } else {
    const DefiniteSystem K(eliminated(with_rows(C.L, R, w), gone), task);
    problem.solve = [&](const VecX& b, double rho) {
      VecX rhs = b / rho;
      for (Eigen::Index i = 0; i < n; ++i)
        if (gone[i]) rhs[i] = 0;
      return K.solve_once(rhs);
    };
    result = admm(problem, admm_options, state, task);
  }
  report.iterations.emplace_back("sharpening", result.iterations);
  report.residuals.emplace_back("sharpening, primal", result.primal);
  report.residuals.emplace_back("sharpening, dual", result.dual);
  if (!result.converged) {
    report.status = "not converged";
    report.warn("sharpening stopped after " + std::to_string(result.iterations) +
                " iterations above the tolerance");
  }
  VecX out = phi0;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!gone[i]) out[i] = s[i] * std::max(0.0, s[i] * result.u[i]) * ops.unit;
  return out;
}

VecX sharpen_in_space(const Operators& ops, const SpMat& rows, const VecX& phi0,
                      SharpenSolver solver, const Task& task, Report& report) {
  const Calculus& C = ops.scalar;
  SourceTerms terms;
  terms.A = rows;
  terms.reached.assign(static_cast<std::size_t>(C.n_components), 0);
  for (const int i : unknowns_of(rows))
    if (C.component[i] >= 0) terms.reached[C.component[i]] = 1;
  SharpenOptions options;
  options.solver = solver;
  if (solver == SharpenSolver::pdhg) options.max_iterations = 2000;  // then it only creeps
  return sharpen(ops, terms, phi0, options, task, report);
}

}  // namespace littoral
