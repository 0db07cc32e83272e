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
      for (int e = D.outerIndexPtr()[j]; e < D.outerIndexPtr()[j + 1]; ++e) {
        const int row = D.innerIndexPtr()[e], cell = row / dim;
        if (cell >= weight.size()) continue;
        const double a = D.valuePtr()[e], w = weight[cell];
        for (int g = G.outerIndexPtr()[row]; g < G.outerIndexPtr()[row + 1]; ++g) {
          const int i = G.innerIndexPtr()[g];
          if (i < j) continue;
          const double product = a * G.valuePtr()[g];
          if (i == j) diagonal += product;
          const int* at = begin;  // few, in ascending order
          while (at != stop && *at < i) ++at;
          if (at == stop || *at != i) {
            elsewhere += std::abs(product);
            continue;
          }
          plain[at - begin] += product;
          out[at - begin] += w * product;
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
