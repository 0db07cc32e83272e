#include "cli/serve.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <iostream>
#include <string_view>

#include "littoral/error.h"

namespace littoral::cli {

namespace {

/// A descriptor that closes itself.
class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

void send_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto sent = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the browser has gone
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// Reads up to the end of the request's head; what does not come in a second is not waited for.
std::string read_request(int fd) {
  const timeval patience = {1, 0};
  ::setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  std::string head;
  char buffer[1024];
  while (head.size() < 16384 && head.find("\r\n\r\n") == std::string::npos) {
    const auto n = ::recv(fd, buffer, sizeof buffer, 0);
    if (n <= 0) break;
    head.append(buffer, static_cast<std::size_t>(n));
  }
  return head;
}

void answer(int fd, const std::string& page) {
  const std::string head = read_request(fd);
  const bool get = head.rfind("GET / ", 0) == 0, only_head = head.rfind("HEAD / ", 0) == 0;
  const std::string_view body = get || only_head ? std::string_view(page) : "not found\n";
  send_all(fd, std::string("HTTP/1.1 ") + (get || only_head ? "200 OK" : "404 Not Found") +
                   "\r\nContent-Type: text/" + (get || only_head ? "html" : "plain") +
                   "; charset=utf-8\r\nContent-Length: " + std::to_string(body.size()) +
                   "\r\nConnection: close\r\n\r\n");
  if (!only_head) send_all(fd, body);
}

}  // namespace

void serve_page(const std::string& page, const Task& task) {
  const Socket listener(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (listener.fd() < 0 || ::bind(listener.fd(), generic, size) != 0 ||
      ::listen(listener.fd(), 16) != 0 || ::getsockname(listener.fd(), generic, &size) != 0)
    throw IoError("cannot open a port on 127.0.0.1");
  std::cout << "http://127.0.0.1:" << ntohs(address.sin_port) << "/\n" << std::flush;
  while (true) {
    task.checkpoint();
    pollfd waiting = {listener.fd(), POLLIN, 0};
    if (::poll(&waiting, 1, 50) <= 0) continue;
    const Socket browser(::accept(listener.fd(), nullptr, nullptr));
    if (browser.fd() >= 0) answer(browser.fd(), page);
  }
}

}  // namespace littoral::cli
