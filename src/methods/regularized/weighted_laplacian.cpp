#include "methods/regularized/weighted_laplacian.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/now_and_then.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t columns_at_once = 4096;
constexpr double rounding = 1e-6;  // of the diagonal, between L and D G

}  // namespace

std::optional<SpMat> weighted_laplacian(const SpMat& L, const SpRows& D, const SpRows& G,
                                        const VecX& weight, int dim, const Task& task) {
  SpMat K = L;
  std::atomic<bool> same = true;
  parallel_for(L.cols(), columns_at_once, [&](std::size_t first, std::size_t end) {
    stop_if_cancelled(task);
    std::vector<double> plain;
    for (int j = static_cast<int>(first); j < static_cast<int>(end); ++j) {
      const int* const begin = L.innerIndexPtr() + L.outerIndexPtr()[j];
      const int* const stop = L.innerIndexPtr() + L.outerIndexPtr()[j + 1];
      const double* const given = L.valuePtr() + L.outerIndexPtr()[j];
      double* const out = K.valuePtr() + L.outerIndexPtr()[j];
      plain.assign(stop - begin, 0);
      std::fill(out, out + (stop - begin), 0.0);
      double diagonal = 0, elsewhere = 0;
      for (SpRows::InnerIterator a(D, j); a; ++a) {
        const Eigen::Index cell = a.col() / dim;
        if (cell >= weight.size()) continue;
        for (SpRows::InnerIterator b(G, a.col()); b; ++b) {
          if (b.col() < j) continue;
          const double product = a.value() * b.value();
          const int* const at = std::lower_bound(begin, stop, static_cast<int>(b.col()));
          if (b.col() == j) diagonal += product;
          if (at == stop || *at != b.col()) {
            elsewhere += std::abs(product);
            continue;
          }
          plain[at - begin] += product;
          out[at - begin] += weight[cell] * product;
        }
      }
      bool here = elsewhere <= rounding * diagonal;
      for (std::size_t k = 0; k < plain.size(); ++k)
        here = here && std::abs(plain[k] - given[k]) <= rounding * diagonal;
      if (!here) same = false;
    }
  });
  if (!same) return std::nullopt;
  return K;
}

}  // namespace littoral
