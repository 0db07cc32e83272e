#include "base/parallel_forest.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <queue>
#include <utility>

#include "base/parallel.h"

namespace littoral {

namespace {

/// The nodes of a forest that wait for nothing, handed out the largest number first.
class ReadyNodes {
 public:
  ReadyNodes(const std::vector<int>& parent, Walk walk)
      : parent_(parent),
        walk_(walk),
        waiting_(parent.size(), 0),
        begin_(parent.size() + 1, 0),
        child_(parent.size()),
        left_(parent.size()) {
    const int n = parent.size();
    for (int p : parent)
      if (p >= 0) ++begin_[p];
    for (int i = 0, sum = 0; i <= n; ++i) sum += std::exchange(begin_[i], sum);
    std::vector<int> at = begin_;
    for (int i = 0; i < n; ++i) {
      if (parent[i] < 0) continue;
      child_[at[parent[i]]++] = i;
      ++waiting_[walk == Walk::from_leaves ? parent[i] : i];
    }
    for (int i = 0; i < n; ++i)
      if (waiting_[i] == 0) ready_.push(i);
  }

  /// The next node, waiting until there is one; -1 when all are done.
  int take() {
    std::unique_lock lock(mutex_);
    if (ready_.empty() && left_ > 0) {
      const WaitsForOthers waits;
      changed_.wait(lock, [&] { return !ready_.empty() || left_ == 0; });
    }
    if (left_ == 0) return -1;
    const int i = ready_.top();
    ready_.pop();
    return i;
  }

  void finish(int i) {
    const std::lock_guard lock(mutex_);
    if (left_ > 0) --left_;
    if (walk_ == Walk::from_roots) {
      for (int c = begin_[i]; c < begin_[i + 1]; ++c) ready_.push(child_[c]);
    } else if (parent_[i] >= 0 && --waiting_[parent_[i]] == 0) {
      ready_.push(parent_[i]);
    }
    changed_.notify_all();
  }

  void stop(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::move(error);
    left_ = 0;
    changed_.notify_all();
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const std::vector<int>& parent_;
  Walk walk_;
  std::vector<int> waiting_, begin_, child_;  // children of i: child_[begin_[i] .. begin_[i + 1])
  std::priority_queue<int> ready_;
  std::size_t left_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::exception_ptr error_;
};

}  // namespace

void parallel_forest(const std::vector<int>& parent, Walk walk,
                     const std::function<void(int)>& body) {
  const int n = parent.size();
  const std::size_t workers = std::min<std::size_t>(parent.size(), thread_count());
  if (workers <= 1) {
    for (int i = 0; i < n; ++i) body(walk == Walk::from_leaves ? i : n - 1 - i);
    return;
  }
  ReadyNodes nodes(parent, walk);
  parallel_for(workers, 1, [&](std::size_t, std::size_t) {
    for (int i; (i = nodes.take()) >= 0;) {
      try {
        body(i);
        nodes.finish(i);
      } catch (...) {  // the others must not wait for what will not come
        nodes.stop(std::current_exception());
        return;
      }
    }
  });
  nodes.rethrow();
}

}  // namespace littoral
