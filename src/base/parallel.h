#pragma once
// Threads. Results never depend on how many there are: work is cut into the same pieces always, and
// reductions add the pieces in order.

#include <cstddef>
#include <functional>

#include "base/platform/floating_point.h"

namespace littoral {

/// Threads used by calls made from this thread (0 = all cores); the default is all.
void set_thread_count(int threads);
int thread_count();
/// Nobody in this process uses more, whatever was set; for what has no room for more.
void set_most_threads(int threads);
int requested_thread_count();  // as it was set: 0 = all cores

/// Calls body(begin, end) over [0, n) cut into pieces of `grain`; pieces may run at the same time.
/// The first exception thrown (lowest piece) is rethrown here. Nested calls run in the caller.
void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// While it lives, its thread, one of those of a loop, waits for the others.
class WaitsForOthers {
 public:
  WaitsForOthers();
  ~WaitsForOthers();
  WaitsForOthers(const WaitsForOthers&) = delete;
  WaitsForOthers& operator=(const WaitsForOthers&) = delete;
};

/// Calls body(begin, end) for a few ranges of at least `least` that make up [0, n), as many as suit
/// the threads: where each range costs a walk over everything, of which it takes what is its own.
/// What comes of it must not depend on where ranges end.
void parallel_ranges(std::size_t n, std::size_t least,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace littoral
