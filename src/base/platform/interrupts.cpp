#include "base/platform/interrupts.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

namespace littoral {

namespace {

// Only the first thread writes to these, and only it has them: nested calls leave the outer one's.
std::atomic<const CancelToken*> raised_by_interrupt{nullptr};
struct sigaction handler_before = {};
// Handlers that may be looking at these: a signal may be handled on any thread.
std::atomic<int> handlers_inside{0};

void raise_and_pass_on(int signal, siginfo_t* info, void* context) {
  ++handlers_inside;
  if (const CancelToken* token = raised_by_interrupt.load()) token->cancel();
  const struct sigaction before = handler_before;
  --handlers_inside;
  if (before.sa_flags & SA_SIGINFO)
    before.sa_sigaction(signal, info, context);
  else if (before.sa_handler != SIG_DFL && before.sa_handler != SIG_IGN)
    before.sa_handler(signal);
}

bool on_first_thread() { return ::syscall(SYS_gettid) == ::getpid(); }

}  // namespace

CancelOnInterrupt::CancelOnInterrupt(const CancelToken& token) : token_(token) {
  if (!on_first_thread() || raised_by_interrupt.load()) return;
  struct sigaction before = {};
  if (sigaction(SIGINT, nullptr, &before) != 0) return;
  const bool has_handler = (before.sa_flags & SA_SIGINFO) != 0 || before.sa_handler != SIG_IGN;
  if (!has_handler) return;
  handler_before = before;
  raised_by_interrupt = &token_;
  struct sigaction action = {};
  action.sa_sigaction = raise_and_pass_on;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  active_ = sigaction(SIGINT, &action, nullptr) == 0;
  if (!active_) raised_by_interrupt = nullptr;
}

CancelOnInterrupt::~CancelOnInterrupt() {
  if (!active_) return;
  sigaction(SIGINT, &handler_before, nullptr);
  raised_by_interrupt = nullptr;
  while (handlers_inside > 0) std::this_thread::yield();  // on other threads, for a moment
}

}  // namespace littoral
