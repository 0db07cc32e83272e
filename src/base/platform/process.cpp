#include "base/platform/process.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

namespace littoral {

namespace {

int wake_end = -1;  // of a pipe; all that a handler may do is write to it

void wake(int) {
  const int before = errno;
  [[maybe_unused]] const auto written = ::write(wake_end, "!", 1);
  errno = before;
}

/// Both ends of a pipe that children do not inherit.
bool make_pipe(int (&ends)[2]) {
  if (::pipe(ends) != 0) return false;
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  return true;
}

}  // namespace

int process_id() { return static_cast<int>(::getpid()); }

bool errors_go_to_terminal() { return ::isatty(STDERR_FILENO) == 1; }

void remove_file(const char* path) noexcept { ::unlink(path); }

void on_interrupt(std::function<void()> react) {
  int ends[2];
  if (!make_pipe(ends)) return;  // the default actions then end the process
  try {
    std::thread([from = ends[0], react = std::move(react)] {
      char byte = 0;
      while (::read(from, &byte, 1) != 1) {
      }
      react();
    }).detach();
  } catch (const std::system_error&) {  // no place for a thread: the same
    for (const int end : ends) ::close(end);
    return;
  }
  wake_end = ends[1];
  // Handlers, not a thread in sigwait: libraries start threads of their own before main, and those
  // would take the signals.
  for (int signal : {SIGINT, SIGTERM}) {
    struct sigaction action = {};
    if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action.sa_handler = wake;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
  }
}

void end_process(std::string_view text, int status) noexcept {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  ::_exit(status);
}

void wait_for_the_end() noexcept {
  while (true) ::pause();
}

}  // namespace littoral
