#include "methods/regularized/weighted_laplacian.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "base/fetch_ahead.h"
#include "base/now_and_then.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t columns_at_once = 4096;
constexpr Eigen::Index ahead = 24, far_ahead = 96;  // entries of D
constexpr double rounding = 1e-6;                   // of the diagonal, between L and D G

}  // namespace

std::optional<SpMat> weighted_laplacian(const SpMat& L, const SpRows& D, const SpRows& G,
                                        const VecX& weight, int dim, const Task& task) {
  SpMat K = L;
  std::atomic<bool> same = true;
  const Eigen::Index entries = D.nonZeros();
  parallel_for(L.cols(), columns_at_once, [&](std::size_t first, std::size_t end) {
    stop_if_cancelled(task);
    std::vector<int> nodes;               // of a column, in ascending order
    std::vector<double> plain, weighted;  // its entries, and what has no place among them
    for (int j = static_cast<int>(first); j < static_cast<int>(end); ++j) {
      const int start = L.outerIndexPtr()[j], n = L.outerIndexPtr()[j + 1] - start;
      nodes.assign(L.innerIndexPtr() + start, L.innerIndexPtr() + start + n);
      nodes.push_back(std::numeric_limits<int>::max());
      plain.assign(n + 1, 0);
      weighted.assign(n + 1, 0);
      double elsewhere = 0;
      for (int e = D.outerIndexPtr()[j]; e < D.outerIndexPtr()[j + 1]; ++e) {
        // Rows of G that neighbouring cells have are far from one another in memory.
        if (e + far_ahead < entries) {
          fetch_ahead(G.outerIndexPtr() + D.innerIndexPtr()[e + far_ahead]);
          const int next = D.innerIndexPtr()[e + ahead], at = G.outerIndexPtr()[next];
          fetch_ahead(weight.data() + next / dim);
          fetch_ahead(G.innerIndexPtr() + at);
          fetch_ahead(G.valuePtr() + at);
        }
        const int row = D.innerIndexPtr()[e], cell = row / dim;
        if (cell >= weight.size()) continue;
        const double a = D.valuePtr()[e], w = weight[cell];
        for (int g = G.outerIndexPtr()[row]; g < G.outerIndexPtr()[row + 1]; ++g) {
          const int i = G.innerIndexPtr()[g];
          const double product = a * G.valuePtr()[g];
          int at = 0;  // they are few, and no branch here can be foreseen
          for (int k = 0; k < n; ++k) at += nodes[k] < i;
          at = nodes[at] == i ? at : n;
          elsewhere += at == n && i >= j ? std::abs(product) : 0;
          plain[at] += product;
          weighted[at] += w * product;
        }
      }
      std::copy_n(weighted.begin(), n, K.valuePtr() + start);
      const double diagonal = n > 0 && nodes[0] == j ? plain[0] : 0;
      bool here = elsewhere <= rounding * diagonal;
      for (int k = 0; k < n; ++k)
        here = here && std::abs(plain[k] - L.valuePtr()[start + k]) <= rounding * diagonal;
      if (!here) same = false;
    }
  });
  if (!same) return std::nullopt;
  return K;
}

}  // namespace littoral
