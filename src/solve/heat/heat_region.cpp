#include "solve/heat/heat_region.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "solve/direct/cholesky.h"
#include "solve/direct/elimination.h"

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
  const int n = int_size(blocks) * block;
  K.resize(n, n);  // a column is what a row has on its right
  int* begin = K.outerIndexPtr();
  at_border.assign(blocks.size(), 0);
  // Columns of a piece of blocks one after the other, as rows are asked for once.
  struct Piece {
    std::vector<int> rows;
    std::vector<Scalar> values;
  };
  std::vector<Piece> pieces((blocks.size() + region_grain - 1) / region_grain);
  parallel_for(blocks.size(), region_grain, [&](std::size_t first, std::size_t end) {
    BlockRow<Scalar> row;
    Piece piece;
    // What edges and nodes of triangles take; more grows.
    const std::size_t enough = 4 * std::size_t(block) * block * (end - first);
    piece.rows.reserve(enough);
    piece.values.reserve(enough);
    stop_if_cancelled(task);
    for (std::size_t k = first; k < end; ++k) {
      const int here = static_cast<int>(k);
      if (k + blocks_ahead < end) A.fetch(blocks[k + blocks_ahead]);
      A.row(blocks[k], row);
      for (int c = 0; c < block; ++c) {
        const std::size_t before = piece.rows.size();
        const auto put = [&](int i, const Scalar& z) {
          piece.rows.push_back(i);
          piece.values.push_back(z);
        };
        for (int i = c; i < block; ++i) put(here * block + i, row.values[i * block + c]);
        for (std::size_t s = 1; s < row.blocks.size(); ++s) {
          const int j = local[row.blocks[s]];
          if (j < 0) at_border[k] = 1;
          if (j <= here) continue;
          const Scalar* z = &row.values[(s * block + c) * block];
          for (int i = 0; i < block; ++i) put(j * block + i, Eigen::numext::conj(z[i]));
        }
        begin[here * block + c] = static_cast<int>(piece.rows.size() - before);
      }
    }
    pieces[first / region_grain] = std::move(piece);
  });
  int sum = 0;
  for (int k = 0; k < n; ++k) sum += std::exchange(begin[k], sum);
  begin[n] = sum;
  K.resizeNonZeros(sum);
  parallel_for(pieces.size(), 1, [&](std::size_t p, std::size_t) {
    const Piece piece = std::move(pieces[p]);
    const int at = begin[p * region_grain * std::size_t(block)];
    std::copy(piece.rows.begin(), piece.rows.end(), K.innerIndexPtr() + at);
    std::copy(piece.values.begin(), piece.values.end(), K.valuePtr() + at);
  });
  for (int i : blocks) local[i] = -1;
}

template <class Scalar>
typename HeatRegion<Scalar>::Vector HeatRegion<Scalar>::solve(const HermitianRows<Scalar>& A,
                                                              const std::vector<char>& known,
                                                              const Vector& x, Vector r,
                                                              const Task& task) const {
  const int block = A.block();
  parallel_for(blocks.size(), region_grain, [&](std::size_t first, std::size_t end) {
    BlockRow<Scalar> row;
    for (std::size_t k = first; k < end; ++k) {
      if (at_border[k] == 0) continue;
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
  Ordering in_order(r.size());
  std::iota(in_order.begin(), in_order.end(), 0);
  const auto structure = std::make_shared<const Elimination>(K, in_order, task);
  return raised_cholesky(K, structure, task).factor.solve(r);
}

template struct HeatRegion<double>;
template struct HeatRegion<Complex>;

}  // namespace littoral
