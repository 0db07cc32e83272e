#pragma once
// How far from its sources heat has decayed by how much, as a heat matrix alone tells.

#include <algorithm>
#include <cstddef>
#include <deque>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/hermitian_rows.h"

namespace littoral {

/// Blocks of M + t L in the order in which heat decays to them. A fast marching method on the graph
/// of the matrix, whose step from neighbours k that are nearer to j is that of plane waves exp(-d)
/// on a lattice, where neighbours lie opposite each other:
///
///   sum over k of w_jk (2 cosh(d_j - d_k) - 2) = M_j,  w of `Coupled`,
///
/// so that meshes may be stretched: the matrix knows their steps.
template <class Scalar>
class OutwardMarch {
 public:
  static constexpr int stride = 16;  // decay lengths; how finely distances are told

  /// M: blocks. from: blocks at distance 0, each once.
  OutwardMarch(const HermitianRows<Scalar>& A, const VecX& M, const std::vector<int>& from);

  /// Goes on to all blocks nearer than so many strides. Throws Cancelled.
  void reach(int strides, const Task& task);
  /// How many blocks are nearer than so many strides, which must have been reached.
  std::size_t nearer_than(int strides) const {
    return nearer_than_[std::min(std::size_t(strides), nearer_than_.size() - 1)];
  }
  /// Nothing is left to reach.
  bool ended() const { return ahead_.size() == free_.size(); }
  /// Blocks reached, nearer ones before; those that were here stay where they are.
  const int* blocks() const { return blocks_.data(); }

 private:
  struct Ahead {                 // a block next to settled ones
    double d;                    // its distance, as far as is known
    double first;                // distance of the first neighbour that was settled
    double w = 0, s = 0, a = 0;  // sums of w, w (2 cosh x - 2), 2 w sinh x over those; x: beyond
                                 // the first
  };
  static constexpr int untouched = -1, settled = -2;

  void settle(int i, double d);

  const HermitianRows<Scalar>& A_;
  const VecX& M_;
  std::vector<int> place_;  // blocks: in ahead_, untouched or settled
  std::vector<Ahead> ahead_;
  std::vector<int> free_;                 // places of ahead_
  std::deque<std::vector<int>> buckets_;  // from the present one on; also of blocks settled before
  std::size_t present_ = 0;               // bucket
  std::vector<int> blocks_;
  std::size_t reached_ = 0;
  std::vector<std::size_t> nearer_than_{0};
  std::vector<Coupled> beside_;
};

extern template class OutwardMarch<double>;
extern template class OutwardMarch<Complex>;

}  // namespace littoral
