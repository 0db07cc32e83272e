#pragma once
// Work that nobody waits for yet.

#include <functional>
#include <memory>

#include "base/task.h"

namespace littoral {

/// Work on a thread of its own while the caller goes on, where more than one thread is to be used
/// and the system has a place for another.
class Beside {
 public:
  explicit Beside(std::function<void()> work);
  /// Waits until it has ended.
  ~Beside();
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  /// Is there such a thread? Otherwise nothing has been done, and the caller must do it.
  bool begun() const;
  /// Returns when it is done; throws what it threw, and Cancelled within 0.05 s of a request.
  void wait(const Task& task);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace littoral
