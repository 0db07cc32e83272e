#pragma once
// Another program, run so that nothing it does can take this one down.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/task.h"

namespace littoral {

/// How a child process ended. One of `status`, `signal` and `timed_out` says it.
struct ChildEnd {
  int status = 0;          // exit status
  int signal = 0;          // that ended it; 0: none
  bool timed_out = false;  // it was ended here
  std::string said;        // the last line it printed, without what cannot be printed
};

/// The last line of what a program printed, without what cannot be printed; at most 200 characters.
std::string last_line_of(std::string_view output);

/// The program as a path: as it is with a '/', otherwise the first executable file of that name in
/// the folders of PATH; nothing where there is none.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// Runs `program` with `arguments` in `folder` and waits for it; its output goes into the file
/// "output" there, its input is empty. It and what it starts are ended after `timeout` seconds by
/// the clock and within 0.05 s of a request to stop; it cannot use more memory than is available
/// now, leaves no core file, and does not outlive this process where the system can see to that.
/// Throws IoError if it cannot be started, Cancelled.
ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const std::filesystem::path& folder, double timeout, const Task& task);

}  // namespace littoral
