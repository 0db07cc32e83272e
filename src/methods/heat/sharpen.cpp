#include "methods/heat/sharpen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/component_values.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/stopwatch.h"
#include "solve/direct/definite.h"
#include "solve/optimization/admm.h"
#include "solve/optimization/bounded_values.h"
#include "solve/optimization/pdhg.h"

namespace littoral {

namespace {

int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// Signs of phi0 on the components that count, 0 at the source.
std::vector<int> signs_of(const Calculus& C, const std::vector<char>& reached, const VecX& phi0) {
  double largest = 0;
  for (const double x : phi0)
    if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
  std::vector<int> out(phi0.size(), 0);
  for (Eigen::Index i = 0; i < phi0.size(); ++i) {
    const int c = C.component[i];
    if (c >= 0 && reached[c] && std::abs(phi0[i]) > 1e-9 * largest) out[i] = sign(phi0[i]);
  }
  return out;
}

/// How far each node of a cell in which phi0 changes sign is from its zero set: |phi0| over the
/// mean slope of those cells. Negative at all other nodes.
VecX distance_to_zero_set(const Calculus& C, const SpRows& G, int dim, const std::vector<int>& s,
                          const VecX& phi0) {
  const Eigen::Index n = phi0.size();
  VecX slope = VecX::Zero(n), weight = VecX::Zero(n);
  std::vector<int> nodes;
  for (Eigen::Index c = 0; c < C.A.size(); ++c) {
    double slope2 = 0;
    bool above = false, below = false;
    nodes.clear();
    for (Eigen::Index r = dim * c; r < dim * (c + 1); ++r) {
      double g = 0;
      for (SpRows::InnerIterator it(G, r); it; ++it) {
        if (it.value() == 0) continue;
        const int i = it.col();
        g += it.value() * phi0[i];
        above = above || s[i] > 0;
        below = below || s[i] < 0;
        if (std::find(nodes.begin(), nodes.end(), i) == nodes.end()) nodes.push_back(i);
      }
      slope2 += g * g;
    }
    if (!above || !below || !(slope2 > 0)) continue;
    for (const int i : nodes) {
      slope[i] += C.A[c] * std::sqrt(slope2);
      weight[i] += C.A[c];
    }
  }
  VecX distance(n);
  for (Eigen::Index i = 0; i < n; ++i)
    distance[i] = weight[i] > 0 ? std::abs(phi0[i]) * weight[i] / slope[i] : -1;
  return distance;
}

/// The rows after the gradient, over h: nodes next to the zero set of phi0, which keep their sign
/// and stay within `bound`; then rows of the source, with the bound 0.
struct BandRows {
  SpMat R;
  std::vector<int> sign;
  VecX bound, weight;
};

/// A row of the source that touches those nodes is left out: phi0 has its zero set there, and a row
/// all of whose nodes have one sign would hold them at 0, a dent.
BandRows band_rows(const Calculus& C, const SpMat& source, int dim, const std::vector<int>& s,
                   const VecX& near) {
  BandRows band;
  Triplets entries;
  std::vector<double> weight, bound;
  for (Eigen::Index i = 0; i < near.size(); ++i) {
    const int c = C.component[i];
    if (near[i] < 0 || c < 0) continue;
    entries.emplace_back(weight.size(), i, 1 / C.h);
    band.sign.push_back(s[i]);
    bound.push_back(near[i] / C.h);
    weight.push_back(C.M[i]);
  }
  const SpRows rows = source;
  for (int r = 0; r < rows.rows(); ++r) {
    bool alone = true;
    for (SpRows::InnerIterator it(rows, r); it; ++it)
      if (it.value() != 0 && near[it.col()] >= 0) alone = false;
    if (!alone) continue;
    for (SpRows::InnerIterator it(rows, r); it; ++it)
      entries.emplace_back(weight.size(), it.col(), it.value() / C.h);
    weight.push_back(10 * std::pow(C.h, dim));
    band.sign.push_back(1);
    bound.push_back(0);
  }
  band.bound = Eigen::Map<const VecX>(bound.data(), bound.size());
  band.weight = Eigen::Map<const VecX>(weight.data(), weight.size());
  band.R.resize(band.weight.size(), near.size());
  band.R.setFromTriplets(entries.begin(), entries.end());
  return band;
}

constexpr Eigen::Index most_for_a_factor = 60'000;  // nodes in space; a factor grows like n^(4/3)

struct Sharpened {
  VecX phi;
  AdmmResult result;
};

Sharpened sharpened(const Calculus& C, double unit, const SpMat& source,
                    const std::vector<char>& reached, const VecX& phi0,
                    const SharpenOptions& options, const Task& task) {
  const Eigen::Index n = C.M.size(), cells = C.A.size();
  const int dim = C.G.rows / cells;
  const std::vector<int> s = signs_of(C, reached, phi0);
  std::vector<char> gone(n, 0);
  VecX start(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int c = C.component[i];
    gone[i] = c < 0 || !reached[c];
    start[i] = gone[i] ? 0 : phi0[i] / unit;
  }
  const SpRows G = C.G.matrix();
  const BandRows band = band_rows(C, source, dim, s, distance_to_zero_set(C, G, dim, s, start));
  const VecX& w = band.weight;
  const Eigen::Index extra = w.size();

  SplitProblem problem;
  problem.dim = dim;
  problem.A.resize(cells + extra);
  problem.A << C.A, w;
  problem.b = VecX::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) problem.b[i] = s[i] * C.M[i];
  const BallQuadraticEnergy ball(dim, 0, 0, VecX());
  const BoundedEnergy energy(ball, dim, cells, band.sign, band.bound);
  problem.energy = &energy;
  problem.G = stacked(G, band.R, dim);

  AdmmState state;
  multiply(problem.G, start, state.z, task);
  for (Eigen::Index c = 0; c < cells + extra; ++c) {
    const VecX given = state.z.segment(dim * c, dim);
    energy.prox(c, 1, given.data(), state.z.data() + dim * c);
  }
  state.w = VecX::Zero(state.z.size());
  state.rho = 2 * problem.length();
  AdmmOptions admm_options;
  admm_options.relative = options.tolerance;
  admm_options.absolute = std::min(5e-6, 5e-4 * options.tolerance);
  admm_options.max_iterations = options.max_iterations;
  AdmmResult result;
  if (options.solver == SharpenSolver::pdhg) {
    result = pdhg(problem, C.M, start, admm_options, task);
  } else {
    const auto matrix = [&] { return eliminated(with_rows(C.L, band.R, w), gone); };
    const bool large = dim == 3 && n > most_for_a_factor;
    const DefiniteSystem K = large ? DefiniteSystem::by_multigrid(matrix, unknowns_of(band.R))
                                   : DefiniteSystem(matrix(), task);
    VecX last = start;
    problem.solve = [&](const VecX& b, double rho) {
      VecX rhs = b / rho;
      for (Eigen::Index i = 0; i < n; ++i)
        if (gone[i]) rhs[i] = 0;
      return large ? last = K.improved(last, rhs, task) : K.solve_once(rhs);
    };
    result = admm(problem, admm_options, state, task);
  }
  VecX out = phi0;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!gone[i]) out[i] = s[i] * std::max(0.0, s[i] * result.u[i]) * unit;
  return {std::move(out), result};
}

/// One component of a domain by itself: its nodes, and its operators and rows of the source on
/// them.
struct Part {
  std::vector<int> nodes;
  Calculus C;
  SpMat source;
};

template <class Matrix>
Matrix restricted(const Matrix& all, const std::vector<int>& row, Eigen::Index rows,
                  const std::vector<int>& col, Eigen::Index cols) {
  Triplets entries;
  for (Eigen::Index o = 0; o < all.outerSize(); ++o)
    for (typename Matrix::InnerIterator it(all, o); it; ++it)
      if (row[it.row()] >= 0 && col[it.col()] >= 0)
        entries.emplace_back(row[it.row()], col[it.col()], it.value());
  Matrix out(rows, cols);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

Part part_of(const Calculus& C, const SpRows& G, const SpMat& source, int component) {
  const Eigen::Index cells = C.A.size();
  const int dim = C.G.rows / cells;
  Part part;
  std::vector<int> node(C.M.size(), -1);
  for (Eigen::Index i = 0; i < C.M.size(); ++i)
    if (C.component[i] == component) {
      node[i] = int_size(part.nodes);
      part.nodes.push_back(i);
    }
  std::vector<int> row(G.rows(), -1), source_row(source.rows(), -1);
  std::vector<double> A;
  for (Eigen::Index c = 0; c < cells; ++c) {
    bool mine = false;
    for (Eigen::Index r = dim * c; r < dim * (c + 1); ++r)
      for (SpRows::InnerIterator it(G, r); it; ++it) mine = mine || node[it.col()] >= 0;
    if (!mine) continue;
    for (int d = 0; d < dim; ++d) row[dim * c + d] = dim * int_size(A) + d;
    A.push_back(C.A[c]);
  }
  int rows = 0;
  const SpRows by_row = source;
  for (int r = 0; r < by_row.rows(); ++r)
    for (SpRows::InnerIterator it(by_row, r); it; ++it)
      if (node[it.col()] >= 0 && source_row[r] < 0) source_row[r] = rows++;
  const Eigen::Index n = index(part.nodes.size());
  Calculus& own = part.C;
  own.A = Eigen::Map<const VecX>(A.data(), index(A.size()));
  own.M.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) own.M[i] = C.M[part.nodes[i]];
  own.L = restricted(C.L, node, n, node, n);
  own.component.assign(n, 0);
  own.n_components = 1;
  // Nodes are as far apart as cells of the same shape and the part's own size have them.
  own.h = C.h * std::pow((own.A.mean()) / C.A.mean(), 1.0 / dim);
  const SpRows gradient = restricted(G, row, dim * own.A.size(), node, n);
  own.G.rows = gradient.rows();
  own.G.cols = gradient.cols();
  own.G.matrix = [gradient] { return gradient; };
  part.source = restricted(source, source_row, rows, node, n);
  return part;
}

}  // namespace

VecX sharpen(const Operators& ops, const SourceSystem& system, const VecX& phi0,
             const SharpenOptions& options, const Task& whole, Report& report) {
  const Calculus& C = ops.scalar;
  const Stopwatch watch(report, "sharpen");
  Task task = whole;
  VecX out = phi0;
  ComponentValues iterations("sharpening"), primal("sharpening, primal"), dual("sharpening, dual");
  int stopped = 0;
  const auto take = [&](int c, const AdmmResult& result) {
    iterations.add(c, result.iterations);
    primal.add(c, result.primal);
    dual.add(c, result.dual);
    stopped += !result.converged;
  };
  if (C.n_components == 1) {
    Sharpened all = sharpened(C, ops.unit, system.A, system.reached, phi0, options, task);
    out = std::move(all.phi);
    take(0, all.result);
  } else {
    const SpRows G = C.G.matrix();
    for (int c = 0; c < C.n_components; ++c) {
      if (!system.reached[c]) continue;
      const Part part = part_of(C, G, system.A, c);
      VecX start(index(part.nodes.size()));
      for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = phi0[part.nodes[i]];
      const Sharpened own = sharpened(part.C, ops.unit, part.source, {1}, start, options,
                                      task.stage(1.0 / C.n_components, "sharpening"));
      for (Eigen::Index i = 0; i < start.size(); ++i) out[part.nodes[i]] = own.phi[i];
      take(c, own.result);
    }
  }
  iterations.report_worst(report.iterations);
  primal.report_worst(report.residuals);
  dual.report_worst(report.residuals);
  if (stopped > 0) {
    report.status = "not converged";
    report.warn("not-converged",
                "sharpening stopped after " +
                    counted(static_cast<int>(iterations.worst()), "iteration", "iterations") +
                    ", above the tolerance: the result is the last iterate");
  }
  return out;
}

VecX sharpen_in_space(const Operators& ops, const SpMat& rows, const VecX& phi0,
                      SharpenSolver solver, const Task& task, Report& report) {
  const Calculus& C = ops.scalar;
  SourceSystem system;
  system.A = rows;
  system.reached.assign(C.n_components, 0);
  for (const int i : unknowns_of(rows))
    if (C.component[i] >= 0) system.reached[C.component[i]] = 1;
  SharpenOptions options;
  options.solver = solver;
  return sharpen(ops, system, phi0, options, task, report);
}

}  // namespace littoral
