#include "cli/interrupt.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string_view>
#include <thread>

#include "io/write.h"

namespace littoral::cli {

namespace {

int wake_end = -1;  // of a pipe; all that a handler may do is write to it

void wake(int) {
  const int before = errno;
  [[maybe_unused]] const auto written = ::write(wake_end, "!", 1);
  errno = before;
}

}  // namespace

void watch_for_interrupts(const CancelToken& cancel) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;  // the default actions then end the process
  wake_end = ends[1];
  std::thread([from = ends[0], cancel] {
    char byte = 0;
    while (::read(from, &byte, 1) != 1) {
    }
    cancel.cancel();
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    exit_interrupted();
  }).detach();
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

void exit_interrupted() {
  static std::atomic<bool> leaving{false};
  if (leaving.exchange(true))
    while (true) ::pause();
  io::remove_unfinished_files();
  constexpr std::string_view text = "\nlittoral: interrupted\n";
  // A terminal shows ^C and perhaps a progress bar on this line.
  const std::string_view line = ::isatty(STDERR_FILENO) == 1 ? text : text.substr(1);
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
  ::_exit(130);
}

}  // namespace littoral::cli
