#pragma once
// Hermitian matrices that are asked for row by row, from memory or made anew each time.

#include <cstddef>
#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// A row of blocks of a matrix, without those that are zero.
template <class Scalar>
struct BlockRow {
  std::vector<int> blocks;     // the one on the diagonal first; each once
  std::vector<Scalar> values;  // of each block, row by row
};

/// How strongly a block is coupled to another one: w where the entry between is -w times a turn.
struct Coupled {
  int block;
  double w;
};

/// A Hermitian matrix of unknowns in blocks, as what looks at a few rows at a time asks for it: one
/// that is as quickly made as read need not be kept. May be asked on several threads.
template <class Scalar>
class HermitianRows {
 public:
  virtual ~HermitianRows() = default;

  virtual int size() const = 0;  // blocks
  virtual int block() const { return 1; }
  /// The other blocks that block i is coupled with, each once, in the place of what was in `out`.
  virtual void neighbours(int i, std::vector<int>& out) const = 0;
  /// Row i of blocks, in the place of what was in `out`.
  virtual void row(int i, BlockRow<Scalar>& out) const = 0;
  /// What block i is coupled to, in the place of what was in `out`; another block may be there more
  /// than once. By the size of entries, which are real or of blocks that turn and scale, where a
  /// matrix does not know better.
  virtual void couplings(int i, std::vector<Coupled>& out) const;
  /// Brings what is asked about block i into the cache; for blocks that are asked for in no order
  /// that memory knows.
  virtual void fetch(int) const {}
};

/// How many blocks before it is asked for one is best fetched.
inline constexpr std::size_t blocks_ahead = 6;

/// The rows of a matrix given by its lower triangle, whose columns ascend.
template <class Scalar>
std::shared_ptr<const HermitianRows<Scalar>> rows_of(
    std::shared_ptr<const Eigen::SparseMatrix<Scalar>> lower, int block);

/// The lower triangle of a matrix given by its rows. Throws Cancelled.
template <class Scalar>
Eigen::SparseMatrix<Scalar> lower_triangle(const HermitianRows<Scalar>& A, const Task& task);

}  // namespace littoral
