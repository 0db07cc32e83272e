#pragma once
// Work that nobody waits for yet.

#include <functional>
#include <memory>

#include "base/task.h"

namespace littoral {

/// Work on a thread of its own while the caller goes on, where more than one thread is to be used
/// and the system has a place for another; otherwise work that is put off. Where it calls
/// `Task::checkpoint` it gives way to loops that keep as many threads busy as are to be used.
/// Whoever waits for it takes part in its loops.
class Beside {
 public:
  class Shared;

  /// What the work is given asks it to stop when nobody waits for it any more.
  explicit Beside(std::function<void(const Task&)> work);
  /// Returns when it has stopped.
  ~Beside();
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  /// Returns when it is done, by the caller where there is no other thread; throws what it threw,
  /// and Cancelled within 0.05 s of a request. Once.
  void finish(const Task& task);

 private:
  std::unique_ptr<Shared> shared_;
};

}  // namespace littoral
