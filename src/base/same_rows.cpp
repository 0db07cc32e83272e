#include "base/same_rows.h"

#include <algorithm>

#include "base/groups.h"
#include "base/index.h"

namespace littoral {

namespace {

/// For each key the first place of the same. Only keys that begin alike are compared.
std::vector<int> first_of_same(const std::vector<std::array<int, 3>>& keys) {
  int n_groups = 0;
  for (const auto& key : keys) n_groups = std::max(n_groups, key[0] + 1);
  Groups<int> alike = groups_of<int>(std::size_t(n_groups), [&](const auto& put) {
    for (int i = 0; i < int_size(keys); ++i) put(keys[i][0], i);
  });
  std::vector<int> first(keys.size());
  for (int g = 0; g < n_groups; ++g) {
    const auto begin = alike.members.begin() + alike.begin[g];
    const auto end = alike.members.begin() + alike.begin[g + 1];
    std::sort(begin, end,
              [&](int a, int b) { return keys[a] < keys[b] || (keys[a] == keys[b] && a < b); });
    for (auto i = begin; i != end; ++i)
      first[*i] = i != begin && keys[*i] == keys[*(i - 1)] ? first[*(i - 1)] : *i;
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

std::vector<RepeatedRow> repeated_rows(const Eigen::Ref<const MatX3i>& rows,
                                       const std::vector<int>& some) {
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
