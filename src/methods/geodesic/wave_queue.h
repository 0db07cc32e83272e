#pragma once
// What a front has before it, by when it is due.

#include <algorithm>
#include <limits>
#include <vector>

namespace littoral {

/// The entries of a front that goes on in waves: together go those that are due before anything of
/// them can change the others by much, which is key <= min(key + lead) over all. What is due soon
/// is in no order, and every wave looks through it; the rest is in a heap, which most never enter.
/// Nothing that comes out depends on which of them an entry is in, but for the order.
class WaveQueue {
 public:
  struct Entry {
    double key;  // when it is due
    int id;
    float lead;  // what it sends is due this much later at least

    double until() const { return key + double(lead); }
    bool operator<(const Entry& other) const {
      return key > other.key || (key == other.key && id > other.id);
    }
  };

  bool empty() const { return near_.empty() && far_.empty(); }
  /// +inf if there is nothing.
  double least() const { return far_.empty() ? least_ : std::min(least_, far_.front().key); }

  /// Of this wave and the next few.
  std::size_t n_soon() const { return near_.size(); }

  void push(const Entry& entry) {
    if (entry.key <= soon_) return push_near(entry);
    far_.push_back(entry);
    std::push_heap(far_.begin(), far_.end());
  }

  /// The least `Entry::until`; +inf if there is nothing.
  double until() {
    while (!far_.empty() && far_.front().key <= until_) {
      push_near(far_.front());
      std::pop_heap(far_.begin(), far_.end());
      far_.pop_back();
    }
    return until_;
  }

  /// Offers what is due until `end` to `take`, which says whether it takes it. What is left stays.
  /// From `least` to `until`, of all queues of the front where there are several.
  template <class Take>
  void take_wave(double begin, double end, const Take& take) {
    const std::size_t n = near_.size();
    until_ = least_ = infinity;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Entry entry = near_[i];
      if (entry.key <= end && take(entry)) continue;
      near_[kept++] = entry;
      least_ = std::min(least_, entry.key);
      until_ = std::min(until_, entry.until());
    }
    near_.resize(kept);
    // A wave looks at few that it does not take.
    soon_ = kept > crowd + 4 * (n - kept) ? -infinity : end + waves_ahead * (end - begin);
  }

  template <class See>
  void for_each(const See& see) const {
    for (const Entry& entry : near_) see(entry);
    for (const Entry& entry : far_) see(entry);
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr double waves_ahead = 3;
  static constexpr std::size_t crowd = 64;

  void push_near(const Entry& entry) {
    near_.push_back(entry);
    least_ = std::min(least_, entry.key);
    until_ = std::min(until_, entry.until());
  }

  std::vector<Entry> near_, far_;               // the second a heap
  double soon_ = -infinity;                     // what is due until then is put among the near ones
  double least_ = infinity, until_ = infinity;  // of the near ones
};

}  // namespace littoral
