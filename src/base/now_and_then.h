#pragma once
// Loops that can be stopped and have no progress to tell of.

#include "base/task.h"
#include "littoral/error.h"

namespace littoral {

inline void stop_if_cancelled(const Task& task) {
  if (task.cancelled()) throw Cancelled();
}

/// The same in step i of a loop of short steps.
inline void stop_now_and_then(int i, const Task& task) {
  if (i % 65536 == 0) stop_if_cancelled(task);
}

}  // namespace littoral
