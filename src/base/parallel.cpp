#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/platform/memory.h"
#include "base/platform/threads.h"

namespace littoral {

namespace {
thread_local int requested_threads = 0;
thread_local bool inside_parallel = false;
}  // namespace

void set_thread_count(int threads) { requested_threads = std::max(0, threads); }

int requested_thread_count() { return requested_threads; }

int thread_count() {
  if (!has_threads) return 1;
  if (requested_threads > 0) return requested_threads;
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  grain = std::max<std::size_t>(1, grain);
  const std::size_t pieces = (n + grain - 1) / grain;
  const std::size_t workers = std::min<std::size_t>(pieces, thread_count());
  if (workers <= 1 || inside_parallel) {
    for (std::size_t p = 0; p < pieces; ++p) body(p * grain, std::min(n, (p + 1) * grain));
    return;
  }
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t error_piece = pieces;
  const std::uint64_t mode = floating_point_mode();
  const double limit = memory_limit();
  auto work = [&] {
    inside_parallel = true;
    set_memory_limit(limit);
    set_floating_point_mode(mode);
    for (std::size_t p; (p = next.fetch_add(1)) < pieces;) {
      try {
        body(p * grain, std::min(n, (p + 1) * grain));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (p < error_piece) {
          error_piece = p;
          error = std::current_exception();
        }
        next.store(pieces);
      }
    }
    inside_parallel = false;
  };
  std::vector<std::thread> threads;
  for (std::size_t w = 1; w < workers; ++w) threads.emplace_back(work);
  work();
  for (auto& thread : threads) thread.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace littoral
