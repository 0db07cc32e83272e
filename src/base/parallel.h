#pragma once
// Threads. Results never depend on how many there are: work is cut into the same pieces always, and
// reductions add the pieces in order.

#include <cstddef>
#include <functional>

namespace littoral {

/// Threads used by calls made from this thread (0 = all cores); the default is all.
void set_thread_count(int threads);
int thread_count();
int requested_thread_count();  // as it was set: 0 = all cores

/// Rounds subnormal numbers to zero on this thread. The factors of heat matrices decay into the
/// subnormal range, where arithmetic is several times slower and the digits are worthless.
void flush_subnormals();

/// Restores the calling thread's floating-point mode when it goes out of scope.
class FlushSubnormals {
 public:
  FlushSubnormals();
  ~FlushSubnormals();
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

 private:
  unsigned saved_;
};

/// Calls body(begin, end) over [0, n) cut into pieces of `grain`; pieces may run at the same time.
/// The first exception thrown (lowest piece) is rethrown here. Nested calls run in the caller.
void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace littoral
