#pragma once
// Ctrl-C: stops within 0.2 s, whatever the program is doing, and leaves no half-written file.

#include "base/task.h"

namespace littoral::cli {

/// Raises the token on SIGINT or SIGTERM; 0.15 s later the process ends with status 130, if it has
/// not done so by itself. Signals that were ignored when the program started stay ignored.
void watch_for_interrupts(const CancelToken& cancel);

/// Removes unfinished files, says so and ends the process with status 130.
[[noreturn]] void exit_interrupted();

}  // namespace littoral::cli
