#pragma once
// Integration in the L1 sense: potentials whose differences miss given ones by as little as
// possible. Exact, by minimum-cost flow.

#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"

namespace littoral {

/// min over s of sum_e w_e |J_e|, J_e = c_e + s_{f(e)} - s_{g(e)}, subject to lo_e <= J_e <= hi_e.
struct L1Integration {
  int n = 0;              // nodes
  std::vector<int> f, g;  // arcs, f != g
  VecX c;                 // arcs
  VecX w;                 // arcs, >= 0
  VecX lo, hi;            // arcs, lo <= 0 <= hi, may be infinite; or empty: no bounds

  Eigen::Index n_arcs() const { return c.size(); }
};

enum class L1Algorithm { automatic, simplex, interior_point };

struct L1Options {
  int algorithm = static_cast<int>(L1Algorithm::automatic);
};

/// Potentials and the flow that proves how good they are.
struct L1Solution {
  VecX s;             // nodes; 0 at the lowest node of every part that arcs with weight connect
  VecX x;             // arcs: multipliers; x_e = w_e sign(J_e) wherever J_e is not 0 or at a bound
  double primal = 0;  // sum w |J|
  double dual = 0;    // the flow's value: a lower bound on every primal one
  double infeasibility = 0;  // largest violation of lo, hi and of conservation, relative
  int iterations = 0;        // of the interior point method
  double pivots = 0;         // of the network simplex

  double scale = 0;  // sum w |c|: what s = 0 costs

  double gap() const;  // (primal - dual) / primal; 0 where both are round-off of `scale`
};

/// Solves by network simplex on integers (36 bits where they fit): the dual problem is a
/// circulation of least cost with arcs f -> g of capacity w either way and cost -c, and an
/// uncapacitated arc for every bound; s is minus its potential. Large problems are first brought
/// close by an interior point method on the grounded Laplacian of the graph, from which the simplex
/// starts.
///
/// primal and dual are evaluated in double with the given c and w. The report gets iterations, and
/// the gap as residual "L1 gap". Throws InputError if an arc is a loop, ends nowhere, has a
/// negative or non-finite number or crossed bounds, or if no s satisfies the bounds.
L1Solution integrate_l1(const L1Integration& problem, const L1Options& options, const Task& task,
                        Report& report);

/// The same, but bounds that no s satisfies are given up: `bounded` tells.
L1Solution integrate_l1_if_bounded(L1Integration problem, const L1Options& options,
                                   const Task& task, Report& report, bool& bounded);

}  // namespace littoral
