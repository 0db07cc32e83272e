#include "cli/interrupt.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <string_view>
#include <thread>

#include "littoral/io/write.h"

namespace littoral::cli {

void watch_for_interrupts(const CancelToken& cancel) {
  sigset_t watched;
  sigemptyset(&watched);
  for (int signal : {SIGINT, SIGTERM}) {
    struct sigaction action = {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      sigaddset(&watched, signal);
  }
  // Blocked here and in every thread started later, the signals wait for the thread that asks.
  pthread_sigmask(SIG_BLOCK, &watched, nullptr);
  std::thread([watched, cancel] {
    int signal = 0;
    if (sigwait(&watched, &signal) != 0) return;
    cancel.cancel();
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    exit_interrupted();
  }).detach();
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
