#include "cli/interrupt.h"

#include <atomic>
#include <chrono>
#include <string_view>
#include <system_error>
#include <thread>

#include "base/platform/process.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

void watch_for_interrupts(const CancelToken& cancel) {
  on_interrupt([cancel] {
    cancel.cancel();
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    exit_interrupted();
  });
}

void TimeLimit::begin(const CancelToken& cancel, double seconds) {
  if (!(seconds > 0)) return;
  try {
    thread_ = std::thread([this, cancel, seconds] {
      std::unique_lock lock(mutex_);
      if (ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return ending_; }))
        return;
      passed_ = true;
      cancel.cancel();
    });
  } catch (const std::system_error& e) {
    throw IoError("cannot start a thread for the time limit: " + e.code().message(), "system");
  }
}

TimeLimit::~TimeLimit() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  ended_.notify_all();
  thread_.join();
}

void exit_interrupted() {
  static std::atomic<bool> leaving{false};
  if (leaving.exchange(true)) wait_for_the_end();
  io::remove_unfinished_files();
  constexpr std::string_view text = "\nlittoral: interrupted\n";
  // A terminal shows ^C and perhaps a progress bar on this line.
  end_process(errors_go_to_terminal() ? text : text.substr(1), 130);
}

}  // namespace littoral::cli
