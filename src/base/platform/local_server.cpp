#include "base/platform/local_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "littoral/error.h"

namespace littoral {

namespace {

void send_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto sent = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the browser has gone
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

std::string read_head(int fd) {
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

}  // namespace

LocalServer::LocalServer() : listener_(::socket(AF_INET, SOCK_STREAM, 0)), port_(0) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (listener_ < 0 || ::bind(listener_, generic, size) != 0 || ::listen(listener_, 16) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    if (listener_ >= 0) ::close(listener_);
    throw IoError("cannot open a port on 127.0.0.1", "system");
  }
  port_ = ntohs(address.sin_port);
}

LocalServer::~LocalServer() { ::close(listener_); }

void LocalServer::answer_one(int milliseconds, const Answer& answer) const {
  pollfd waiting = {listener_, POLLIN, 0};
  if (::poll(&waiting, 1, milliseconds) <= 0) return;
  struct Browser {
    int fd;
    ~Browser() {
      if (fd >= 0) ::close(fd);
    }
  } const browser{::accept(listener_, nullptr, nullptr)};
  if (browser.fd < 0) return;
  answer(read_head(browser.fd), [&](std::string_view bytes) { send_all(browser.fd, bytes); });
}

}  // namespace littoral
