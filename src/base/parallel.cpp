#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/beside.h"
#include "base/now_and_then.h"
#include "base/platform/memory.h"
#include "base/platform/threads.h"
#include "base/thread_crew.h"

namespace littoral {

namespace {
thread_local int requested_threads = 0;
std::atomic<int> most_threads{std::numeric_limits<int>::max()};
thread_local bool inside_parallel = false;
thread_local ThreadCrew* kept_crew = nullptr;
thread_local Beside::Shared* loops_open_to = nullptr;  // the caller of this thread's work
std::atomic<int> at_work{0};                           // threads in loops that several share

/// Counts its thread among those.
struct AtWork {
  AtWork() { ++at_work; }
  ~AtWork() { --at_work; }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;
};
}  // namespace

WaitsForOthers::WaitsForOthers() { --at_work; }

WaitsForOthers::~WaitsForOthers() { ++at_work; }

void set_thread_count(int threads) { requested_threads = std::max(0, threads); }

int requested_thread_count() { return requested_threads; }

void set_most_threads(int threads) { most_threads = std::max(1, threads); }

int thread_count() {
  if (!has_threads) return 1;
  static const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return std::min(requested_threads > 0 ? requested_threads : cores, most_threads.load());
}

/// A loop that several threads share. Each works as the one that made it would.
class SharedLoop {
 public:
  /// Pieces are begun in order; with several shares in order in each, whose first piece comes first
  /// for the thread of its number: in loop after loop it finds there what it left in its cache.
  SharedLoop(std::size_t n, const std::function<void(std::size_t)>& body, std::size_t shares = 1)
      : shares_(shares), body_(body), mode_(floating_point_mode()), limit_(memory_limit()) {
    for (std::size_t s = 0; s < shares; ++s) {
      shares_[s].next = s * n / shares;
      shares_[s].end = (s + 1) * n / shares;
    }
  }
  SharedLoop(std::size_t n, std::function<void(std::size_t)>&& body,
             std::size_t shares = 1) = delete;  // it must stay

  /// Returns when nothing is left to begin, or `enough` says so between pieces.
  void work(std::size_t thread = 0, const std::function<bool()>& enough = {}) {
    const bool inside = std::exchange(inside_parallel, true);
    const double limit = memory_limit();
    const std::uint64_t mode = floating_point_mode();
    set_memory_limit(limit_);
    set_floating_point_mode(mode_);
    for (std::size_t s = 0; s < shares_.size(); ++s)
      take(shares_[(thread + s) % shares_.size()], enough);
    set_floating_point_mode(mode);
    set_memory_limit(limit);
    inside_parallel = inside;
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  struct alignas(64) Share {  // a line of memory, which others do not write to
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
  };

  void take(Share& share, const std::function<bool()>& enough) {
    for (std::size_t i; !(enough && enough()) && (i = share.next.fetch_add(1)) < share.end;) {
      try {
        body_(i);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (i < failed_) {
          failed_ = i;
          error_ = std::current_exception();
        }
        // Not what comes before it: that may fail, too.
        for (Share& s : shares_)
          if (s.end > i) s.next = s.end;
      }
    }
  }

  std::vector<Share> shares_;
  const std::function<void(std::size_t)>& body_;
  const std::uint64_t mode_;
  const double limit_;
  std::mutex mutex_;
  std::exception_ptr error_;
  std::size_t failed_ = std::numeric_limits<std::size_t>::max();
};

/// Fewer where the system has no place for more: the work is the same, whoever does it.
template <class Work>
void add_threads(std::vector<std::thread>& threads, std::size_t n, const Work& work) {
  threads.reserve(n);
  try {
    for (std::size_t w = 0; w < n; ++w) threads.emplace_back(work);
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
}

class Beside::Shared {
 public:
  explicit Shared(std::function<void(const Task&)> what) : work_(std::move(what)) {}
  ~Shared() {
    stop_.cancel();
    for (auto& thread : threads_) thread.join();
  }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  void start() {
    add_threads(threads_, 1, [this] {
      loops_open_to = this;
      whole_.work();
      const std::lock_guard lock(mutex_);
      over_ = true;
      changed_.notify_one();
    });
  }

  /// A loop of the work's own thread, to whose caller it is open.
  void share(SharedLoop& loop) {
    {
      const std::lock_guard lock(mutex_);
      open_ = &loop;
      ++round_;
    }
    changed_.notify_one();
    loops_open_to = nullptr;  // loops inside run in their callers
    {
      const AtWork counted;
      loop.work();
    }
    loops_open_to = this;
    std::unique_lock lock(mutex_);
    open_ = nullptr;
    changed_.wait(lock, [&] { return !helped_; });
  }

  void finish(const Task& task) {
    if (threads_.empty()) {
      work_(task);
      return;
    }
    awaited_ = true;
    std::unique_lock lock(mutex_);
    for (std::uint64_t seen = 0; !over_; stop_if_cancelled(task)) {
      const auto something = [&] { return over_ || (open_ != nullptr && round_ != seen); };
      if (!changed_.wait_for(lock, std::chrono::milliseconds(20), something) || over_) continue;
      seen = round_;
      helped_ = true;
      SharedLoop& loop = *open_;
      lock.unlock();
      {
        const AtWork counted;
        loop.work(1, [&] { return task.cancelled(); });
      }
      lock.lock();
      helped_ = false;
      changed_.notify_one();
    }
    whole_.rethrow();
  }

 private:
  /// Leaves the processors to loops that keep all threads busy, until somebody waits: such loops
  /// are what the caller has to do, and when they end there is a thread to spare.
  void give_way() const {
    while (at_work.load() >= threads_wanted_ && !awaited_.load() && !stop_.cancelled())
      std::this_thread::sleep_for(std::chrono::microseconds(200));
  }

  const std::function<void(const Task&)> work_;
  const CancelToken stop_;
  const int threads_wanted_ = thread_count();
  std::atomic<bool> awaited_{false};
  const std::function<void(std::size_t)> piece_ = [this](std::size_t) {
    work_(Task(stop_, [this](double, const std::string&) { give_way(); }));
  };
  SharedLoop whole_{1, piece_};
  std::mutex mutex_;  // of all that follows but the thread
  std::condition_variable changed_;
  SharedLoop* open_ = nullptr;  // which the work's thread is in
  std::uint64_t round_ = 0;     // loops so far
  bool helped_ = false;         // the caller is in it
  bool over_ = false;
  std::vector<std::thread> threads_;  // one or none
};

void parallel_for(std::size_t n, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  grain = std::max<std::size_t>(1, grain);
  const std::size_t pieces = (n + grain - 1) / grain;
  const std::size_t workers = std::min<std::size_t>(pieces, thread_count());
  const std::function<void(std::size_t)> piece = [&](std::size_t p) {
    body(p * grain, std::min(n, (p + 1) * grain));
  };
  if (loops_open_to != nullptr && pieces > 1) {
    SharedLoop loop(pieces, piece);
    loops_open_to->share(loop);
    loop.rethrow();
    return;
  }
  if (workers <= 1 || inside_parallel) {
    for (std::size_t p = 0; p < pieces; ++p) piece(p);
    return;
  }
  if (kept_crew != nullptr && kept_crew->size() == thread_count()) {
    kept_crew->run(pieces, piece);
    return;
  }
  SharedLoop loop(pieces, piece);
  std::vector<std::thread> threads;
  const auto work = [&] {
    const AtWork counted;
    loop.work();
  };
  add_threads(threads, workers - 1, work);
  work();
  for (auto& thread : threads) thread.join();
  loop.rethrow();
}

void parallel_ranges(std::size_t n, std::size_t least,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t threads = inside_parallel ? 1 : std::size_t(std::min(thread_count(), 4));
  const std::size_t ranges = threads > 1 ? 2 * threads : 1;  // they need not take the same time
  parallel_for(n, std::max(n / ranges + 1, least), body);
}

Beside::Beside(std::function<void(const Task&)> work)
    : shared_(std::make_unique<Shared>(std::move(work))) {
  if (thread_count() > 1 && !inside_parallel) shared_->start();
}

Beside::~Beside() = default;

void Beside::finish(const Task& task) { shared_->finish(task); }

struct ThreadCrew::Shared {
  static constexpr int patience = 8000;  // looks, some 80 us, before a thread goes to sleep

  /// Returns when `done` does not hold any more: soon if that is soon.
  template <class Done>
  void wait(std::condition_variable& changed, const Done& done) {
    for (int i = 0; i < patience; ++i) {
      if (done()) return;
      pause_briefly();
    }
    std::unique_lock lock(mutex);
    changed.wait(lock, done);
  }
  /// The mutex, which is held for moments: whoever slept until it is free would wake too late.
  std::unique_lock<std::mutex> lock_soon() {
    std::unique_lock lock(mutex, std::try_to_lock);
    for (int i = 0; !lock && i < patience; ++i) {
      pause_briefly();
      (void)lock.try_lock();
    }
    if (!lock) lock.lock();
    return lock;
  }
  void start() {
    started = true;
    add_threads(threads, std::size_t(n_threads - 1), [this] { help(); });
  }
  void help() {
    const std::size_t number = ++helpers;  // the caller is 0
    for (std::uint64_t seen = 0;;) {
      wait(begun, [&] { return round.load() != seen; });
      SharedLoop* mine = nullptr;
      {
        const auto lock = lock_soon();
        seen = round.load();
        if (over) return;
        mine = loop;
        if (mine == nullptr) continue;  // too late
        ++inside;
      }
      {
        const AtWork counted;
        mine->work(number);
      }
      const auto lock = lock_soon();
      if (--inside == 0) ended.notify_one();
    }
  }
  void begin(SharedLoop* what, bool last = false) {
    {
      const auto lock = lock_soon();
      loop = what;
      over = last;
      ++round;
    }
    begun.notify_all();
  }
  /// Waits for those only that have begun.
  void end() {
    {
      const auto lock = lock_soon();
      loop = nullptr;
    }
    wait(ended, [&] { return inside.load() == 0; });
  }

  const int n_threads = inside_parallel ? 1 : thread_count();
  std::vector<std::thread> threads;
  bool started = false;
  std::mutex mutex;  // of all that follows; two of it are read without
  std::condition_variable begun, ended;
  std::atomic<std::uint64_t> round{0};
  std::atomic<std::size_t> helpers{0};
  std::atomic<int> inside{0};  // threads in the loop, without the caller's
  SharedLoop* loop = nullptr;  // what there is to do
  bool over = false;
};

ThreadCrew::ThreadCrew() : shared_(std::make_unique<Shared>()) {}

ThreadCrew::~ThreadCrew() {
  if (shared_->threads.empty()) return;
  shared_->begin(nullptr, true);
  for (auto& thread : shared_->threads) thread.join();
}

int ThreadCrew::size() const { return shared_->n_threads; }

void ThreadCrew::run(std::size_t n, const std::function<void(std::size_t)>& body) {
  if (n <= 1 || size() == 1 || inside_parallel) {
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
  if (!shared_->started) shared_->start();
  SharedLoop loop(n, body, std::size_t(size()));
  const AtWork counted;
  shared_->begin(&loop);
  loop.work();
  shared_->end();
  loop.rethrow();
}

KeepThreads::KeepThreads() : before_(kept_crew) { kept_crew = &crew_; }

KeepThreads::~KeepThreads() { kept_crew = before_; }

}  // namespace littoral
