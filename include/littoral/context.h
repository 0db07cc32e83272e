#pragma once
// How a call runs: on how many threads, whom it tells of its progress, who may stop it.

#include <atomic>
#include <functional>
#include <memory>
#include <string>

namespace littoral {

/// A flag that any thread (or a signal handler) may raise; copies share the flag.
class CancelToken {
 public:
  CancelToken() : raised_(std::make_shared<std::atomic<bool>>(false)) {}
  void cancel() const { raised_->store(true, std::memory_order_relaxed); }
  bool cancelled() const { return raised_->load(std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> raised_;
};

/// The last, optional argument of every long call. Results do not depend on it.
struct Context {
  int threads = 0;  // 0: all cores
  /// Called with the share of the work that is done, 0..1, never less than before, and what is
  /// being done; from the thread that computes.
  std::function<void(double fraction, const std::string& stage)> progress{};
  /// Once raised, the call throws Cancelled within 0.2 s.
  CancelToken cancel{};
  /// Work foreseen to need more is an IoError before it is begun [bytes]; 0: what the system has.
  double memory_limit = 0;
};

}  // namespace littoral
