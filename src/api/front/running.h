#pragma once
// A call of the public interface while it runs: its context is the thread's until it ends.

#include "base/parallel.h"
#include "base/platform/memory.h"
#include "base/task.h"
#include "littoral/context.h"

namespace littoral {

class Running {
 public:
  explicit Running(const Context& context)
      : task(context.cancel, context.progress),
        threads_(requested_thread_count()),
        limit_(memory_limit()) {
    if (context.threads > 0) set_thread_count(context.threads);
    if (context.memory_limit > 0) set_memory_limit(context.memory_limit);
  }
  ~Running() {
    set_thread_count(threads_);
    set_memory_limit(limit_);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  Task task;

 private:
  int threads_;
  double limit_;
};

}  // namespace littoral
