#pragma once
// Threads that stay: for loops so short that starting threads for each would cost more than they
// save, or is felt.

#include <cstddef>
#include <functional>
#include <memory>

namespace littoral {

/// As many threads as `thread_count()` says where it is made, the caller's among them. They are
/// started by the first loop and end with the crew.
class ThreadCrew {
 public:
  ThreadCrew();
  ~ThreadCrew();
  ThreadCrew(const ThreadCrew&) = delete;
  ThreadCrew& operator=(const ThreadCrew&) = delete;

  int size() const;  // 1 inside another parallel loop

  /// Calls body(0), ..., body(n - 1), which may run at the same time. The first exception thrown
  /// (lowest number) is rethrown here. For one caller at a time.
  void run(std::size_t n, const std::function<void(std::size_t i)>& body);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

/// While it lives, every `parallel_for` of the thread that made it is shared with the same crew.
/// To be ended by that thread, the last one first.
class KeepThreads {
 public:
  KeepThreads();
  ~KeepThreads();
  KeepThreads(const KeepThreads&) = delete;
  KeepThreads& operator=(const KeepThreads&) = delete;

 private:
  ThreadCrew crew_;
  ThreadCrew* const before_;
};

}  // namespace littoral
