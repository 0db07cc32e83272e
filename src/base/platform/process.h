#pragma once
// This process: what it is called, where its messages go, how it ends.

#include <functional>
#include <string_view>

namespace littoral {

/// The number by which the system knows this process.
int process_id();

/// Is the standard error a terminal?
bool errors_go_to_terminal();

/// Removes a file, without allocating memory; a signal handler may call it.
void remove_file(const char* path) noexcept;

/// Calls `react` on a thread of its own at the first request to stop (SIGINT, SIGTERM). Requests
/// that were ignored when the program started stay ignored. To be called once.
void on_interrupt(std::function<void()> react);

/// Writes `text` to the standard error and ends the process with `status`, without destructors.
[[noreturn]] void end_process(std::string_view text, int status) noexcept;

/// Waits until the process ends.
[[noreturn]] void wait_for_the_end() noexcept;

}  // namespace littoral
