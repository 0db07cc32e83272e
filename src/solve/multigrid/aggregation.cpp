#include <algorithm>
#include <cmath>
#include <vector>

#include "base/now_and_then.h"
#include "base/parallel.h"
#include "solve/multigrid/multigrid.h"

namespace littoral {

namespace {

constexpr std::size_t aggregated_rows = 1 << 15;

/// Which entries of A are strong couplings. Those of a row may be in any order.
std::vector<char> strong_couplings(const SpRows& A, double strength) {
  VecX d = VecX::Zero(A.rows());
  parallel_for(std::size_t(A.rows()), aggregated_rows, [&](std::size_t first, std::size_t last) {
    for (int i = int(first); i < int(last); ++i)
      for (SpRows::InnerIterator it(A, i); it; ++it)
        if (it.col() == i) d[i] = it.value();
  });
  std::vector<char> strong(A.nonZeros(), 0);
  parallel_for(std::size_t(A.rows()), aggregated_rows, [&](std::size_t first, std::size_t last) {
    for (int i = int(first); i < int(last); ++i)
      for (int e = A.outerIndexPtr()[i]; e < A.outerIndexPtr()[i + 1]; ++e) {
        const int j = A.innerIndexPtr()[e];
        strong[e] = j != i && -A.valuePtr()[e] > strength * std::sqrt(d[i] * d[j]);
      }
  });
  return strong;
}

/// Group of each unknown, -1 for those that are coupled to nothing; returns the number of groups.
int find_groups(const SpRows& A, const std::vector<char>& strong, std::vector<int>& group,
                const Task& task) {
  const int n = A.rows();
  const int* begin = A.outerIndexPtr();
  const int* to = A.innerIndexPtr();
  group.assign(n, -1);
  int n_groups = 0;
  auto checked = [&](int i) {
    if (i % 65536 == 0) task.checkpoint();
    return group[i] < 0;
  };
  // An unknown with all its strong neighbours, where none of them is taken yet.
  for (int i = 0; i < n; ++i) {
    if (!checked(i)) continue;
    bool any = false, free = true;
    for (int e = begin[i]; e < begin[i + 1] && free; ++e)
      if (strong[e]) {
        any = true;
        free = group[to[e]] < 0;
      }
    if (!any || !free) continue;
    group[i] = n_groups;
    for (int e = begin[i]; e < begin[i + 1]; ++e)
      if (strong[e]) group[to[e]] = n_groups;
    ++n_groups;
  }
  // The others join the group that they are coupled to most, of those made so far.
  std::vector<int> joined(group);
  parallel_for(std::size_t(n), aggregated_rows, [&](std::size_t first, std::size_t last) {
    stop_if_cancelled(task);
    for (int i = int(first); i < int(last); ++i) {
      if (group[i] >= 0) continue;
      double most = 0;
      for (int e = begin[i]; e < begin[i + 1]; ++e)
        if (strong[e] && group[to[e]] >= 0 && -A.valuePtr()[e] > most) {
          most = -A.valuePtr()[e];
          joined[i] = group[to[e]];
        }
    }
  });
  group = std::move(joined);
  // What is left is strongly coupled to nothing that has a group.
  for (int i = 0; i < n; ++i) {
    if (!checked(i)) continue;
    bool any = false;
    for (int e = begin[i]; e < begin[i + 1]; ++e)
      if (strong[e] && group[to[e]] < 0) {
        any = true;
        group[to[e]] = n_groups;
      }
    if (any) group[i] = n_groups++;
  }
  // Weakly coupled unknowns would be lost on the coarse level: they go with any neighbour.
  for (int i = 0; i < n; ++i) {
    if (!checked(i)) continue;
    double most = 0;
    for (int e = begin[i]; e < begin[i + 1]; ++e)
      if (to[e] != i && group[to[e]] >= 0 && std::abs(A.valuePtr()[e]) > most) {
        most = std::abs(A.valuePtr()[e]);
        group[i] = group[to[e]];
      }
  }
  return n_groups;
}

}  // namespace

SpRows smoothed_aggregation(const SpRows& A, double strength, const Task& task) {
  constexpr double damping = 2.0 / 3;
  const std::vector<char> strong = strong_couplings(A, strength);
  std::vector<int> group;
  const int n_groups = find_groups(A, strong, group, task);
  // P = (1 - damping D^-1 A') P0, A' = A with weak couplings added to the diagonal D.
  const auto make = [&](int i, RowInMaking& row) {
    if (group[i] < 0) return;
    double D = 0;
    row.at(group[i]);  // comes first
    for (int e = A.outerIndexPtr()[i]; e < A.outerIndexPtr()[i + 1]; ++e) {
      const int j = A.innerIndexPtr()[e];
      if (strong[e] && group[j] >= 0)
        row.at(group[j]) += A.valuePtr()[e];
      else
        D += A.valuePtr()[e];
    }
    const double scale = D > 0 ? -damping / D : 0;
    for (double& entry : row.entries()) entry *= scale;
    row.at(group[i]) += D > 0 ? 1 - damping : 1;
  };
  return made_rows(A.rows(), n_groups, make, task);
}

}  // namespace littoral
