#include "solve/direct/minimum_degree.h"

#include <bit>
#include <cstddef>

namespace littoral {

MinimumDegree::MinimumDegree(int n, int boundary)
    : n_(n), words_(std::size_t(n + boundary + 63) / 64), bits_(words_ * std::size_t(n), 0) {
  for (int v = 0; v < n; ++v) add_edge(v, v);
}

std::vector<int> MinimumDegree::order() {
  std::vector<int> order, left(n_), degree(n_, 0);
  for (int v = 0; v < n_; ++v) {
    left[v] = v;
    for (std::size_t k = 0; k < words_; ++k) degree[v] += std::popcount(row(v)[k]);
  }
  order.reserve(left.size());
  while (!left.empty()) {
    std::size_t at = 0;
    for (std::size_t k = 1; k < left.size(); ++k)
      if (degree[left[k]] < degree[left[at]]) at = k;
    const int v = left[at];
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    order.push_back(v);
    std::uint64_t* mine = row(v);
    mine[v / 64] &= ~bit(v);
    for (int first = 0; first < n_; first += 64)
      for (std::uint64_t rest = mine[first / 64]; rest != 0; rest &= rest - 1) {
        const int u = first + std::countr_zero(rest);
        if (u >= n_) break;  // the boundary
        std::uint64_t* other = row(u);
        other[v / 64] &= ~bit(v);
        --degree[u];
        for (std::size_t k = 0; k < words_; ++k) {
          const std::uint64_t fresh = mine[k] & ~other[k];
          if (fresh == 0) continue;
          other[k] |= fresh;
          for (std::uint64_t bits = fresh; bits != 0; bits &= bits - 1)
            ++degree[u];  // they are few
        }
      }
  }
  return order;
}

}  // namespace littoral
