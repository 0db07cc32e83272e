#pragma once
// Work in processes of their own that start in no time and take nothing down with them.

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace littoral {

/// What a piece of work may take; 0: no limit.
struct ForkLimits {
  double seconds = 0;  // by the clock
  double memory = 0;   // that it can write to beyond what the server can [bytes]
};

/// How a piece of work ended. Without `signal`, `timed_out` and `not_started` it did so by itself.
struct ForkEnd {
  std::uint64_t id = 0;
  int signal = 0;            // that ended it; 0: none
  bool timed_out = false;    // it was ended after its time
  std::string not_started;   // why there was no process
  std::string told;          // what the work said, as far as it came
  std::string printed;       // the end of what it wrote to its standard output and error
  double seconds = 0;        // by the clock
  double start_seconds = 0;  // of these, until the work began
  double peak_memory = 0;    // [bytes]
};

/// A process that is copied once, when this is made, and then forks a child for each piece of work:
/// it has one thread, does not grow, and has loaded all that the work needs. Requests to stop from
/// a terminal do not reach it or its children; they end with the process that made it.
class ForkServer {
 public:
  /// Says something to the process that asked; may be called several times.
  using Tell = std::function<void(std::string_view bytes)>;
  /// Does the piece of work that `request` describes, in the child. What it throws is lost.
  using Work = std::function<void(const std::string& request, const Tell& tell)>;
  /// What must happen around a fork, in an interpreter for instance.
  struct Hooks {
    std::function<void()> before, in_parent, in_child;
  };

  /// Throws IoError if there can be no process.
  explicit ForkServer(Work work, Hooks hooks = {});
  /// Ends all children.
  ~ForkServer();
  ForkServer(const ForkServer&) = delete;
  ForkServer& operator=(const ForkServer&) = delete;

  /// Begins a piece of work. Throws IoError when the server is gone.
  void start(std::uint64_t id, const std::string& request, const ForkLimits& limits) const;
  /// The next piece of work that ends within so many seconds, if any does. Throws IoError when the
  /// server is gone.
  std::optional<ForkEnd> wait(double seconds) const;

 private:
  int socket_ = -1;
  pid_t server_ = -1;
};

}  // namespace littoral
