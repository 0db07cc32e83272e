#pragma once
// Things that take a while to make and cannot be interrupted.

#include <memory>

#include "base/task.h"

namespace littoral {

/// What `make()` returns, or Cancelled within 0.05 s of a request to stop; `make` must own what it
/// touches.
template <class Make>
auto run_interruptible(const Task& task, Make make) {
  auto out = std::make_shared<std::shared_ptr<const decltype(make())>>();
  run_abandonable(task, [out, make] { *out = std::make_shared<const decltype(make())>(make()); });
  return *out;
}

}  // namespace littoral
