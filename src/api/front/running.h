#pragma once
// A call of the public interface while it runs: its context is the thread's until it ends.

#include <type_traits>

#include "base/parallel.h"
#include "base/platform/memory.h"
#include "base/task.h"
#include "littoral/context.h"

namespace littoral {

/// The context of a part of a call, whose progress goes from one share of it to another.
inline Context part_of(Context context, double begin, double end) {
  if (context.progress)
    context.progress = [begin, end, whole = context.progress](double fraction,
                                                              const std::string& stage) {
      whole(begin + (end - begin) * fraction, stage);
    };
  return context;
}

/// What `body(task)` returns, on the context's threads and within its memory; the last progress
/// reported is 1.
template <class Body>
auto run(const Context& context, const Body& body) {
  struct Restored {
    int threads = requested_thread_count();
    double limit = memory_limit();
    ~Restored() {
      set_thread_count(threads);
      set_memory_limit(limit);
    }
  } const before;
  if (context.threads > 0) set_thread_count(context.threads);
  if (context.memory_limit > 0) set_memory_limit(context.memory_limit);
  const auto done = [&] {
    if (context.progress) context.progress(1, "done");
  };
  const Task task(context.cancel, context.progress);
  if constexpr (std::is_void_v<decltype(body(task))>) {
    body(task);
    done();
  } else {
    auto out = body(task);
    done();
    return out;
  }
}

}  // namespace littoral
