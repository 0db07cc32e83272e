#include "solve/heat/heat_region.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "solve/direct/cholesky.h"

namespace littoral {

namespace {
constexpr std::size_t region_grain = 4096;  // blocks
}  // namespace

template <class Scalar>
HeatRegion<Scalar>::HeatRegion(const HermitianRows<Scalar>& A, std::vector<int> own_blocks,
                               std::vector<int>& local, const Task& task)
    : blocks(std::move(own_blocks)) {
  const int block = A.block();
  for (std::size_t k = 0; k < blocks.size(); ++k) local[blocks[k]] = k;
  const int n_blocks = int_size(blocks), n = n_blocks * block;
  K.resize(n, n);  // a column is what a row has on its right
  int* begin = K.outerIndexPtr();
  parallel_for(blocks.size(), region_grain, [&](std::size_t first, std::size_t end) {
    std::vector<int> beside;
    for (std::size_t k = first; k < end; ++k) {
      A.neighbours(blocks[k], beside);
      const auto right = std::count_if(beside.begin(), beside.end(),
                                       [&](int j) { return local[j] > static_cast<int>(k); });
      for (int c = 0; c < block; ++c)
        begin[index(k) * block + c] = block - c + block * static_cast<int>(right);
    }
  });
  int sum = 0;
  for (int k = 0; k < n; ++k) sum += std::exchange(begin[k], sum);
  begin[n] = sum;
  K.resizeNonZeros(sum);
  parallel_for(blocks.size(), region_grain, [&](std::size_t first, std::size_t end) {
    BlockRow<Scalar> row;
    stop_if_cancelled(task);
    for (std::size_t k = first; k < end; ++k) {
      const int here = static_cast<int>(k);
      A.row(blocks[k], row);
      for (int c = 0; c < block; ++c) {
        int e = begin[here * block + c];
        const auto put = [&](int i, const Scalar& z) {
          K.innerIndexPtr()[e] = i;
          K.valuePtr()[e++] = z;
        };
        for (int i = c; i < block; ++i) put(here * block + i, row.values[i * block + c]);
        for (std::size_t s = 1; s < row.blocks.size(); ++s) {
          const int j = row.blocks[s];
          if (local[j] <= here) continue;
          const Scalar* z = &row.values[(s * block + c) * block];
          for (int i = 0; i < block; ++i) put(local[j] * block + i, Eigen::numext::conj(z[i]));
        }
      }
    }
  });
  for (int i : blocks) local[i] = -1;
  Ordering in_order(n);
  std::iota(in_order.begin(), in_order.end(), 0);
  structure = std::make_shared<const Elimination>(K, in_order, task);
}

template <class Scalar>
typename HeatRegion<Scalar>::Vector HeatRegion<Scalar>::solve(const HermitianRows<Scalar>& A,
                                                              const std::vector<char>& known,
                                                              const Vector& x, Vector r,
                                                              const Task& task) const {
  const int block = A.block();
  parallel_for(blocks.size(), region_grain, [&](std::size_t first, std::size_t end) {
    std::vector<int> beside;
    BlockRow<Scalar> row;
    for (std::size_t k = first; k < end; ++k) {
      A.neighbours(blocks[k], beside);
      if (std::ranges::none_of(beside, [&](int j) { return known[j] != 0; })) continue;
      A.row(blocks[k], row);
      for (std::size_t s = 1; s < row.blocks.size(); ++s) {
        const int j = row.blocks[s];
        if (!known[j]) continue;
        for (int c = 0; c < block; ++c) {
          const Scalar* z = &row.values[(s * block + c) * block];
          for (int i = 0; i < block; ++i) r[index(k) * block + c] -= z[i] * x[j * block + i];
        }
      }
    }
  });
  return raised_cholesky(K, structure, task).factor.solve(r);
}

template struct HeatRegion<double>;
template struct HeatRegion<Complex>;

}  // namespace littoral
