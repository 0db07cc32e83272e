#include "base/platform/interrupts.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

namespace littoral {

namespace {

// Only the first thread writes to these, and only it has them: nested calls leave the outer one's.
std::atomic<const CancelToken*> raised_by_interrupt{nullptr};
struct sigaction handler_before = {};

void raise_and_pass_on(int signal, siginfo_t* info, void* context) {
  if (const CancelToken* token = raised_by_interrupt.load()) token->cancel();
  if (handler_before.sa_flags & SA_SIGINFO)
    handler_before.sa_sigaction(signal, info, context);
  else if (handler_before.sa_handler != SIG_DFL && handler_before.sa_handler != SIG_IGN)
    handler_before.sa_handler(signal);
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
}

}  // namespace littoral
