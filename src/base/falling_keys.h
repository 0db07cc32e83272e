#pragma once
// A queue of numbers whose keys fall while they wait.

#include <vector>

namespace littoral {

/// Numbers from 0 to n - 1 with keys: the least key comes first, of equal ones the smaller number.
/// Each number waits once; four children a node, as most keys that fall rise by a level or two.
class FallingKeys {
 public:
  explicit FallingKeys(int n) : place_(n, -1) {}

  bool empty() const { return heap_.empty(); }
  /// Lets i wait, or wait with this key instead of a larger one.
  void put(int i, double key) {
    if (place_[i] < 0) {
      place_[i] = static_cast<int>(heap_.size());
      heap_.push_back({key, i});
    }
    rise(place_[i], {key, i});
  }
  /// Takes the first number out.
  int take() {
    const int first = heap_.front().i;
    const Entry last = heap_.back();
    heap_.pop_back();
    place_[first] = -1;
    if (!heap_.empty()) sink(last);
    return first;
  }

 private:
  struct Entry {
    double key;
    int i;
    bool operator<(const Entry& o) const { return key < o.key || (key == o.key && i < o.i); }
  };

  void set(int at, const Entry& entry) {
    heap_[at] = entry;
    place_[entry.i] = at;
  }
  void rise(int at, const Entry& entry) {
    for (; at > 0 && entry < heap_[(at - 1) / 4]; at = (at - 1) / 4) set(at, heap_[(at - 1) / 4]);
    set(at, entry);
  }
  /// From the top.
  void sink(const Entry& entry) {
    const int n = static_cast<int>(heap_.size());
    int at = 0;
    for (int child = 1; child < n; child = 4 * at + 1) {
      const int end = child + 4 < n ? child + 4 : n;
      int least = child;
      for (int c = child + 1; c < end; ++c)
        if (heap_[c] < heap_[least]) least = c;
      if (entry < heap_[least]) break;
      set(at, heap_[least]);
      at = least;
    }
    set(at, entry);
  }

  std::vector<Entry> heap_;
  std::vector<int> place_;  // in it; -1: not there
};

}  // namespace littoral
