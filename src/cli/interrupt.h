#pragma once
// Ctrl-C: stops within 0.2 s, whatever the program is doing, and leaves no half-written file.

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/task.h"

namespace littoral::cli {

/// Raises the token on SIGINT or SIGTERM; 0.15 s later the process ends with status 130, if it has
/// not done so by itself. Signals that were ignored when the program started stay ignored.
void watch_for_interrupts(const CancelToken& cancel);

/// Raises a token after some time, while it lives.
class TimeLimit {
 public:
  TimeLimit() = default;
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  /// [seconds]; 0: never. Throws IoError where there is no place for a thread.
  void begin(const CancelToken& cancel, double seconds);
  bool passed() const { return passed_; }

 private:
  std::atomic<bool> passed_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ending_ = false;
  std::thread thread_;
};

/// Removes unfinished files, says so and ends the process with status 130.
[[noreturn]] void exit_interrupted();

}  // namespace littoral::cli
