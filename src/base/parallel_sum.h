#pragma once
// Sums, largest numbers and the like of many things, by all threads.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace littoral {

/// What piece(begin, end) finds of [0, n) cut into pieces of `grain`, joined in order, from `none`
/// on: the same for any number of threads.
template <class T, class Piece, class Join = std::plus<>>
T of_pieces(std::size_t n, std::size_t grain, T none, const Piece& piece, const Join& join = {}) {
  if (n <= grain) return n == 0 ? none : join(none, piece(std::size_t(0), n));
  std::vector<T> found((n + grain - 1) / grain, none);
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    found[begin / grain] = piece(begin, end);
  });
  for (T& next : found) none = join(std::move(none), std::move(next));
  return none;
}

struct Larger {
  template <class T>
  T operator()(const T& a, const T& b) const {
    return std::max(a, b);
  }
};

}  // namespace littoral
