#pragma once
// A page for the browser on this machine.

#include <string>

#include "base/task.h"

namespace littoral::cli {

/// Answers GET / with the page on a free port of 127.0.0.1, whose address it prints to stdout,
/// until the task is cancelled. Throws Cancelled, or IoError if no port can be opened.
[[noreturn]] void serve_page(const std::string& page, const Task& task);

}  // namespace littoral::cli
