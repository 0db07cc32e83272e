#pragma once
// Symmetric distances between all pairs of nodes (Edelstein, Guillen, Solomon, Ben-Chen 2023,
// section 6 and supplement 9), and what can be said of any matrix of distances.

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "operators/calculus.h"
#include "solve/direct/definite.h"

namespace littoral {

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<Symmetric>& all_pairs_options();

/// Bytes that `all_pairs` takes for so many nodes and cells, with numbers of 8 or 4 bytes.
double all_pairs_memory(double nodes, double cells, double bytes_per_number);

/// Minimises eq. 13 with the Dirichlet energy by Alg. 2 on one connected domain: U (nodes x nodes)
/// [length of the input], symmetric to the last bit, 0 on the diagonal, not negative; +inf for
/// nodes in no cell. Reports iterations, the largest relative residual and the longest gradient.
/// Throws UnsupportedError for several components, IoError, before anything is allocated, with the
/// estimate if memory does not suffice.
MatX all_pairs(const Operators& ops, const Symmetric& options, const Task& task, Report& report);

/// Section 7.3's measures of a matrix of distances.
struct PairStatistics {
  double largest_asymmetry = 0, mean_asymmetry = 0;  // |D - D^T| over sqrt(area)
  double violations = 0;         // share of triplets of different nodes against the triangle
                                 // inequality, of the symmetric part of D
  double largest_violation = 0;  // over sqrt(area)
  double triplets = 0;           // looked at, all three within reach of each other
};

/// D: nodes x nodes, columns are sources; entries that are not finite are left out. area: of the
/// domain, in the square of D's unit. Asymmetry is that of all pairs. Triangles are those of all
/// pairs of `statistics_nodes` nodes, evenly spread by their numbers, each with all third nodes.
PairStatistics pair_statistics(const MatX& D, double area, const Task& task);

/// How many of n nodes the triangle inequality is checked from: all of up to 1000, and of more so
/// many that there are half a billion triplets.
Eigen::Index statistics_nodes(Eigen::Index n);

}  // namespace littoral
