#pragma once
// A page for the browser on this machine, and the library behind it.

#include <optional>
#include <string>

#include "base/task.h"
#include "desk/desk.h"

namespace littoral::cli {

/// Answers on a free port of 127.0.0.1 until the task is cancelled, and prints the page's address
/// to stdout. It holds a random word; who does not know it is refused, as are other hosts' names
/// and other sites' pages. With `given` the page may compute: POST /call holds a desk's request.
/// Throws Cancelled, or IoError if no port can be opened.
[[noreturn]] void serve_page(const std::string& page, const std::optional<desk::Given>& given,
                             int threads, const Task& task);

}  // namespace littoral::cli
