#pragma once
// A port of this machine alone, for a browser.

#include <functional>
#include <string>
#include <string_view>

namespace littoral {

/// Listens on a free port of 127.0.0.1 as long as it lives.
class LocalServer {
 public:
  /// What came in, up to the end of a request's head, and how to send bytes back.
  using Send = std::function<void(std::string_view bytes)>;
  using Answer = std::function<void(const std::string& head, const Send& send)>;

  /// Throws IoError if no port can be opened.
  LocalServer();
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  int port() const { return port_; }

  /// Waits up to `milliseconds` for a request, and answers it. What does not come in, or go out,
  /// within a second is not waited for.
  void answer_one(int milliseconds, const Answer& answer) const;

 private:
  int listener_, port_;
};

}  // namespace littoral
