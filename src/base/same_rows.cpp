#include "base/same_rows.h"

#include <algorithm>
#include <array>
#include <utility>

namespace littoral {

std::vector<RepeatedRow> repeated_rows(const MatX3i& rows, const std::vector<int>& some) {
  std::vector<std::pair<std::array<int, 3>, int>> keyed;
  keyed.reserve(some.size());
  for (const int r : some) {
    std::array<int, 3> key{rows(r, 0), rows(r, 1), rows(r, 2)};
    std::sort(key.begin(), key.end());
    keyed.emplace_back(key, r);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<RepeatedRow> out;
  for (std::size_t i = 1, first = 0; i < keyed.size(); ++i) {
    if (keyed[i].first != keyed[first].first)
      first = i;
    else
      out.push_back({keyed[i].second, keyed[first].second});
  }
  return out;
}

}  // namespace littoral
