// What the paper reports of matrices of distances: asymmetry and the triangle inequality (figures
// 11 and 12, table 3).

#include <cmath>

#include "base/index.h"
#include "base/parallel.h"
#include "methods/regularized/all_pairs.h"

namespace littoral {

PairStatistics pair_statistics(const MatX& D, double area, const Task& task) {
  const Eigen::Index n = D.rows();
  const double root = std::sqrt(area);
  MatX S(n, n);
  PairStatistics out;
  double sum = 0, pairs = 0;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double a = D(i, j), b = D(j, i);
      const bool finite = std::isfinite(a) && std::isfinite(b);
      S(i, j) = finite ? 0.5 * (a + b) : infinity;
      if (!finite || i == j) continue;
      out.largest_asymmetry = std::max(out.largest_asymmetry, std::abs(a - b) / root);
      sum += std::abs(a - b) / root;
      ++pairs;
    }
  out.mean_asymmetry = pairs > 0 ? sum / pairs : 0;
  // Pairs i < j with i in steps; every k.
  const Eigen::Index step = std::max<Eigen::Index>(1, n / 600);
  const double round_off = 1e-12 * root;
  struct Count {
    double triplets = 0, violated = 0, largest = 0;
  };
  std::vector<Count> counts((n + step - 1) / step);
  parallel_for(counts.size(), 4, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (std::size_t p = begin; p < end; ++p) {
      const Eigen::Index i = index(p) * step;
      Count& count = counts[p];
      for (Eigen::Index j = i + 1; j < n; ++j) {
        const double d = S(i, j);
        if (!std::isfinite(d)) continue;
        int violated = 0, reached = -2;  // k = i and k = j do not count
        double least = infinity;
        const double* a = S.col(i).data();
        const double* b = S.col(j).data();
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
    }
  });
  double violated = 0;
  for (const Count& count : counts) {
    out.triplets += count.triplets;
    violated += count.violated;
    out.largest_violation = std::max(out.largest_violation, count.largest);
  }
  out.violations = out.triplets > 0 ? violated / out.triplets : 0;
  return out;
}

}  // namespace littoral
