#include "base/same_rows.h"

#include <algorithm>
#include <numeric>

#include "base/index.h"

namespace littoral {

namespace {

/// For each key the first place of the same.
std::vector<int> first_of_same(const std::vector<std::array<int, 3>>& keys) {
  std::vector<int> order(keys.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return keys[a] < keys[b] || (keys[a] == keys[b] && a < b); });
  std::vector<int> first(keys.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool again = i > 0 && keys[order[i]] == keys[order[i - 1]];
    first[order[i]] = again ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace

std::vector<int> first_of_each(const std::vector<std::array<int, 3>>& keys) {
  const std::vector<int> first = first_of_same(keys);
  std::vector<int> out;
  for (int i = 0; i < int_size(first); ++i)
    if (first[i] == i) out.push_back(i);
  return out;
}

std::vector<RepeatedRow> repeated_rows(const MatX3i& rows, const std::vector<int>& some) {
  std::vector<std::array<int, 3>> keys;
  keys.reserve(some.size());
  for (const int r : some) {
    keys.push_back({rows(r, 0), rows(r, 1), rows(r, 2)});
    std::sort(keys.back().begin(), keys.back().end());
  }
  const std::vector<int> first = first_of_same(keys);
  std::vector<RepeatedRow> out;
  for (int i = 0; i < int_size(first); ++i)
    if (first[i] != i) out.push_back({some[i], some[first[i]]});
  return out;
}

}  // namespace littoral
