#pragma once
// Progress and cancellation: one handle, passed down by reference, split into weighted stages.

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "littoral/context.h"

namespace littoral {

/// A range of the whole job's progress. Default-constructed it reports nothing and is never
/// cancelled.
///
/// A job of several stages hands each a `stage(weight, name)`; a loop calls `checkpoint(fraction)`.
/// Fractions reported to the callback never decrease. Checkpoints are at most 0.2 s apart:
/// uninterruptible library calls run through `run_abandonable`.
class Task {
 public:
  using Callback = std::function<void(double fraction, const std::string& stage)>;

  Task() = default;
  explicit Task(CancelToken cancel, Callback callback = {});

  /// The next stage, taking `share` (0..1) of this task's range from where the last stage ended.
  Task stage(double share, const std::string& name);

  /// Reports the fraction (0..1) of this task that is done; throws Cancelled if asked to stop.
  void checkpoint(double fraction = 0) const;

  bool cancelled() const;

  /// Is cancelled as this one is and reports nothing: for work that others than the caller do.
  Task silent() const;

 private:
  struct Shared {
    CancelToken cancel;
    Callback callback;
    std::mutex mutex;
    double reported = 0;
  };
  std::shared_ptr<Shared> shared_;
  std::string name_;
  double begin_ = 0, end_ = 1, next_ = 0;
};

/// Runs a call that cannot be interrupted on a thread of its own and waits for it, throwing
/// Cancelled within 0.05 s of a request to stop. The abandoned call runs on in the background (it
/// must own what it touches) and is joined when the process ends.
void run_abandonable(const Task& task, std::function<void()> call);

}  // namespace littoral
