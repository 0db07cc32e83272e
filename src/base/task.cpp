#include "base/task.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <system_error>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "base/platform/memory.h"
#include "base/platform/threads.h"
#include "littoral/error.h"

namespace littoral {

Task::Task(CancelToken cancel, Callback callback) : shared_(std::make_shared<Shared>()) {
  shared_->cancel = std::move(cancel);
  shared_->callback = std::move(callback);
}

Task Task::stage(double share, const std::string& name) {
  Task sub = *this;
  sub.name_ = name;
  sub.begin_ = std::min(end_, begin_ + next_ * (end_ - begin_));
  next_ = std::min(1.0, next_ + share);
  sub.end_ = begin_ + next_ * (end_ - begin_);
  sub.next_ = 0;
  sub.checkpoint(0);
  return sub;
}

void Task::checkpoint(double fraction) const {
  if (!shared_) return;
  if (shared_->cancel.cancelled()) throw Cancelled();
  if (!shared_->callback) return;
  const double at = begin_ + std::clamp(fraction, 0.0, 1.0) * (end_ - begin_);
  const std::lock_guard lock(shared_->mutex);
  shared_->reported = std::max(shared_->reported, at);
  shared_->callback(shared_->reported, name_);
}

bool Task::cancelled() const { return shared_ && shared_->cancel.cancelled(); }

Task Task::silent() const { return shared_ ? Task(shared_->cancel) : Task(); }

namespace {
/// Threads whose callers have gone; joined at exit so that no library is torn down under them.
class Abandoned {
 public:
  void keep(std::thread thread) {
    const std::lock_guard lock(mutex_);
    threads_.push_back(std::move(thread));
  }
  ~Abandoned() {
    for (auto& thread : threads_) thread.join();
  }

 private:
  std::mutex mutex_;
  std::vector<std::thread> threads_;
};

Abandoned& abandoned() {
  static Abandoned list;
  return list;
}
}  // namespace

void run_abandonable(const Task& task, std::function<void()> call) {
  task.checkpoint();
  if (!has_threads) {
    call();
    task.checkpoint();
    return;
  }
  abandoned();  // constructed before, hence destroyed after, whatever the call constructs
  const auto job = std::make_shared<std::packaged_task<void()>>(
      [call, threads = thread_count(), limit = memory_limit()] {
        set_thread_count(threads);
        set_memory_limit(limit);
        flush_subnormals();
        call();
      });
  auto done = job->get_future();
  std::thread thread;
  try {
    thread = std::thread([job] { (*job)(); });
  } catch (const std::system_error&) {  // no place for a thread
    call();
    task.checkpoint();
    return;
  }
  while (done.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
    if (task.cancelled()) {
      abandoned().keep(std::move(thread));
      throw Cancelled();
    }
  }
  thread.join();
  done.get();
  task.checkpoint();
}

}  // namespace littoral
