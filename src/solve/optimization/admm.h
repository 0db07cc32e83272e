#pragma once
// min 1/2 u^T P u - b^T u + sum_c A_c phi(c, (G u)_c) by alternating directions (Boyd et al.,
// "Distributed optimization and statistical learning via the alternating direction method of
// multipliers", 2011). Knows matrices only.

#include <functional>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "solve/direct/sparse_rows.h"
#include "solve/optimization/gradient_energy.h"

namespace littoral {

/// The problem, through the products and solves it takes.
struct SplitProblem {
  VecX b;       // unknowns
  VecX A;       // cells, positive: the weights of the cells and of all norms over them
  int dim = 2;  // numbers a cell
  SpRows G;     // dim cells x unknowns
  std::function<VecX(const VecX& u)> quadratic;  // P u; empty: P = 0
  using Solve = std::function<VecX(const VecX& b)>;
  std::function<VecX(const VecX& b, double rho)> solve;  // argmin 1/2 u^T (P + rho G^T A G) u - b^T
                                                         // u over the u that are allowed
  /// The same for a penalty of each cell, factored for it; D is divergence(). Empty, or an empty
  /// answer: there is no such solve.
  std::function<Solve(const VecX& rho, const SpRows& D)> solve_cells;
  VecX near_gradient, near_multipliers;  // dim cells: about G u and y of the answer; or empty
  const GradientEnergy* energy = nullptr;
  std::vector<char> fixed;  // unknowns that are held; if given, the gauge of a cell that
                            // has others is |(G u)_c|, and the answer may be moved
                            // around a few cells where that is more than 1
  std::function<VecX(VecX u)> allowed;  // empty: all u; otherwise the nearest u, in some sense,
                                        // that meets what `energy` asks beside the gauge

  SpRows divergence() const;  // D = G^T A, unknowns x dim cells
  double length() const;      // the dim-th root of the total weight: what penalties scale with
};

struct AdmmOptions {
  double rho = 2;          // first penalty, times the length of the problem
  double relative = 1e-2;  // eps^rel
  double absolute = 5e-6;  // eps^abs
  double gap = 0;          // > 0: stop below this relative duality gap, whatever the residuals
  double certified = 0;    // > 0: below the residuals' tolerances the gap must be below this too
  int max_iterations = 10000;
  double relaxation = 1.8;     // over-relaxation (3.4.3)
  int penalty_changes = 1000;  // at most (3.4.1); 0 keeps rho
  double least = 0.02;  // penalty of a cell in multiples of 4 lengths, where cells have theirs
};

/// z and the scaled multiplier y / rho: what a later solve may start from.
struct AdmmState {
  VecX z, w;
  double rho = 0;
  std::vector<AdmmState> parts;  // of a problem that falls into parts, and then nothing else
  bool empty() const { return z.size() == 0 && parts.empty(); }
};

struct AdmmResult {
  VecX u;
  double objective = 0;         // of u shrunk until G u is allowed everywhere
  double gap = 0;               // objective minus a lower bound of it, over |objective|
  double primal = 0, dual = 0;  // residuals, scale-free
  double largest = 0;           // largest gauge of G u: 1.01 means a gradient 1 % too long
  int iterations = 0;
  bool converged = false;
  double convexified = 0;  // multiple of the sum of A |G u|^2 / 2 that was added to the energy
  int component = 0;       // of a problem that is one of several parts
  std::vector<AdmmResult> parts;  // of a problem that falls into parts: theirs, without u; what is
                                  // above is then the sum or the worst of them
};

/// Minimises; the last iterate comes back with converged = false when iterations run out. Starts
/// from `state` if it is not empty and leaves its last state there. Where there is `solve_cells`,
/// every cell has a penalty of its own, in proportion to its multiplier: at once where multipliers
/// are about known, otherwise from the 10th iteration on, and anew after 10, 30, 60, 90, 135, 205,
/// ... iterations.
AdmmResult admm(const SplitProblem& problem, const AdmmOptions& options, AdmmState& state,
                const Task& task);

/// Number of iterations, residuals, gap and status, for a report; also of each part.
void report_admm(const AdmmResult& result, Report& report);

}  // namespace littoral
