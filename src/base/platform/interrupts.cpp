#include "base/platform/interrupts.h"

#if !defined(__EMSCRIPTEN__)
#include <sys/syscall.h>
#include <unistd.h>
#endif

#include <atomic>
#include <csignal>
#include <thread>

namespace littoral {

namespace {

// Only the first thread writes to these, and only it has them: nested calls leave the outer one's.
std::atomic<const CancelToken*> raised_by_interrupt{nullptr};
struct sigaction action_before = {};  // for the first thread alone
// Where the signal went before: one of these, or nowhere. A handler may begin on another thread
// when the call that set them has ended and the next one sets them again.
std::atomic<void (*)(int, siginfo_t*, void*)> before_with_info{nullptr};
std::atomic<void (*)(int)> before_alone{nullptr};
// Handlers that may be looking at these: a signal may be handled on any thread.
std::atomic<int> handlers_inside{0};

void raise_and_pass_on(int signal, siginfo_t* info, void* context) {
  ++handlers_inside;
  if (const CancelToken* token = raised_by_interrupt.load()) token->cancel();
  --handlers_inside;
  if (const auto with_info = before_with_info.load())
    with_info(signal, info, context);
  else if (const auto alone = before_alone.load())
    alone(signal);
}

#if defined(__EMSCRIPTEN__)
bool on_first_thread() { return true; }
#else
bool on_first_thread() { return ::syscall(SYS_gettid) == ::getpid(); }
#endif

}  // namespace

CancelOnInterrupt::CancelOnInterrupt(const CancelToken& token) : token_(token) {
  if (!on_first_thread() || raised_by_interrupt.load()) return;
  struct sigaction before = {};
  if (sigaction(SIGINT, nullptr, &before) != 0) return;
  const bool with_info = (before.sa_flags & SA_SIGINFO) != 0;
  if (!with_info && before.sa_handler == SIG_IGN) return;
  before_with_info = with_info ? before.sa_sigaction : nullptr;
  before_alone = with_info || before.sa_handler == SIG_DFL ? nullptr : before.sa_handler;
  action_before = before;
  raised_by_interrupt = &token_;
  struct sigaction action = {};
  action.sa_sigaction = raise_and_pass_on;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  active_ = sigaction(SIGINT, &action, nullptr) == 0;
  if (!active_) raised_by_interrupt = nullptr;
}

CancelOnInterrupt::~CancelOnInterrupt() {
  if (!active_) return;
  sigaction(SIGINT, &action_before, nullptr);
  raised_by_interrupt = nullptr;
  while (handlers_inside > 0) std::this_thread::yield();  // on other threads, for a moment
}

}  // namespace littoral
