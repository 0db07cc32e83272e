// What the paper reports of matrices of distances: asymmetry and the triangle inequality (figures
// 11 and 12, table 3).

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/parallel.h"
#include "methods/regularized/all_pairs.h"

namespace littoral {

namespace {

constexpr double most_triplets = 5e8;  // a second or so

struct PairCounts {
  double sum = 0, pairs = 0;  // asymmetries
  double triplets = 0, violated = 0;
  double largest = 0;  // of either kind
};

/// |D - D^T| below the diagonal, in blocks of rows and columns that stay in the cache.
void add_asymmetry(const MatX& D, double root, PairStatistics& out, const Task& task) {
  constexpr Eigen::Index side = 64;
  const Eigen::Index n = D.rows(), blocks = (n + side - 1) / side;
  std::vector<PairCounts> counts(blocks);
  parallel_for(counts.size(), 1, [&](std::size_t block, std::size_t) {
    task.checkpoint();
    PairCounts count;
    const Eigen::Index first = index(block) * side, last = std::min(n, first + side);
    for (Eigen::Index rows = first; rows < n; rows += side)
      for (Eigen::Index j = first; j < last; ++j)
        for (Eigen::Index i = std::max(rows, j + 1); i < std::min(n, rows + side); ++i) {
          if (!std::isfinite(D(i, j)) || !std::isfinite(D(j, i))) continue;
          const double difference = std::abs(D(i, j) - D(j, i)) / root;
          count.largest = std::max(count.largest, difference);
          count.sum += difference;
          ++count.pairs;
        }
    counts[block] = count;
  });
  double sum = 0, pairs = 0;
  for (const PairCounts& count : counts) {
    out.largest_asymmetry = std::max(out.largest_asymmetry, count.largest);
    sum += count.sum;
    pairs += count.pairs;
  }
  out.mean_asymmetry = pairs > 0 ? sum / pairs : 0;
}

}  // namespace

Eigen::Index statistics_nodes(Eigen::Index n) {
  return std::min(n, index(std::sqrt(2 * most_triplets / static_cast<double>(std::max(n, {1})))));
}

PairStatistics pair_statistics(const MatX& D, double area, const Task& task) {
  const Eigen::Index n = D.rows(), m = statistics_nodes(n);
  const double root = std::sqrt(area);
  PairStatistics out;
  add_asymmetry(D, root, out, task);
  // Pairs i < j of some nodes, evenly spread; every k.
  const auto node = [&](std::size_t p) { return index(p) * n / m; };
  MatX S(n, m);  // columns of the symmetric part
  parallel_for(std::size_t(m), 1, [&](std::size_t p, std::size_t) {
    const Eigen::Index i = node(p);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double a = D(k, i), b = D(i, k);
      S(k, index(p)) = std::isfinite(a) && std::isfinite(b) ? 0.5 * (a + b) : infinity;
    }
  });
  const double round_off = 1e-12 * root;
  std::vector<PairCounts> counts(m);
  parallel_for(counts.size(), 4, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(static_cast<double>(begin) / static_cast<double>(m));
    for (std::size_t p = begin; p < end; ++p) {
      PairCounts count;
      for (std::size_t q = p + 1; q < counts.size(); ++q) {
        const double d = S(node(p), index(q));
        if (!std::isfinite(d)) continue;
        int violated = 0, reached = -2;  // k = i and k = j do not count
        double least = infinity;
        const double* a = S.col(index(p)).data();
        const double* b = S.col(index(q)).data();
        for (Eigen::Index k = 0; k < n; ++k) {
          const double around = a[k] + b[k];  // k = i, j: d itself
          violated += around < d - round_off;
          reached += std::isfinite(around);
          least = std::min(least, around);
        }
        count.violated += violated;
        count.triplets += reached;
        count.largest = std::max(count.largest, (d - least) / root);
      }
      counts[p] = count;
    }
  });
  double violated = 0;
  for (const PairCounts& count : counts) {
    out.triplets += count.triplets;
    violated += count.violated;
    out.largest_violation = std::max(out.largest_violation, count.largest);
  }
  out.violations = out.triplets > 0 ? violated / out.triplets : 0;
  return out;
}

}  // namespace littoral
