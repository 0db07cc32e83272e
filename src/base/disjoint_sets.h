#pragma once
// Disjoint sets of numbers.

#include <algorithm>
#include <numeric>
#include <vector>

namespace littoral {

/// 0 to n - 1, each in a set of its own until joined; a set is led by its lowest number.
class DisjointSets {
 public:
  explicit DisjointSets(int n = 0) : leader_(n) { std::iota(leader_.begin(), leader_.end(), 0); }

  int size() const { return leader_.size(); }
  /// One more number; returns it.
  int add() {
    leader_.push_back(size());
    return size() - 1;
  }
  /// The leader of a's set.
  int find(int a) {
    while (leader_[a] != a) a = leader_[a] = leader_[leader_[a]];
    return a;
  }
  /// False if they were in one set already.
  bool join(int a, int b) {
    a = find(a);
    b = find(b);
    leader_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
  /// Numbers the sets from 0 by their leaders; -1 for members of sets that are not `used`, where
  /// all members of a set are marked alike (empty: all are). `count` gets how many there are.
  std::vector<int> numbered(int& count, const std::vector<char>& used = {}) {
    std::vector<int> number(leader_.size(), -1);
    count = 0;
    for (int a = 0; a < size(); ++a) {
      if (!used.empty() && !used[a]) continue;
      int& of_set = number[find(a)];
      if (of_set < 0) of_set = count++;
      number[a] = of_set;
    }
    return number;
  }

 private:
  std::vector<int> leader_;
};

}  // namespace littoral
