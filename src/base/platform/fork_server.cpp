#include "base/platform/fork_server.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <system_error>
#include <type_traits>
#include <utility>

#include "base/platform/child_start.h"
#include "base/platform/memory.h"
#include "littoral/error.h"

namespace littoral {

namespace {

using Clock = std::chrono::steady_clock;

double now() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

bool send_bytes(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(to, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes.remove_prefix(std::size_t(sent));
  }
  return true;
}

bool receive_bytes(int from, char* to, std::size_t size) {
  while (size > 0) {
    const ssize_t got = ::recv(from, to, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    size -= std::size_t(got);
  }
  return true;
}

/// Numbers and texts as bytes; both ends are the same program.
class Message {
 public:
  Message() = default;
  template <class T>
  Message& add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Message& add(const std::string& text) { return add(text.size()), bytes_ += text, *this; }
  template <class T>
  void take(T& value) {
    bytes_.copy(reinterpret_cast<char*>(&value), sizeof value, at_);
    at_ += sizeof value;
  }
  void take(std::string& text) {
    std::size_t size = 0;
    take(size);
    text = bytes_.substr(at_, size);
    at_ += size;
  }
  /// As `receive` reads it.
  void append_to(std::string& sent) const { sent += Message().add(bytes_.size()).bytes_ + bytes_; }
  bool send(int to) const {
    std::string whole;
    append_to(whole);
    return send_bytes(to, whole);
  }
  bool receive(int from) {
    std::size_t size = 0;
    if (!receive_bytes(from, reinterpret_cast<char*>(&size), sizeof size)) return false;
    bytes_.resize(size);
    at_ = 0;
    return receive_bytes(from, bytes_.data(), size);
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

/// A file in memory: a full disk does not lose what a child says.
int memory_file() {
#if defined(__linux__)
  return ::memfd_create("littoral", MFD_CLOEXEC);
#else
  std::FILE* file = std::tmpfile();
  const int copy = file ? ::dup(::fileno(file)) : -1;
  if (file) std::fclose(file);
  return copy;
#endif
}

void write_all(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    bytes.remove_prefix(std::size_t(written));
  }
}

/// The last `most` bytes of a file, which is closed.
std::string take_file(int file, off_t most) {
  const off_t size = ::lseek(file, 0, SEEK_END), begin = std::max<off_t>(0, size - most);
  std::string bytes(std::size_t(std::max<off_t>(0, size - begin)), '\0');
  std::size_t have = 0;
  while (have < bytes.size()) {
    const ssize_t got =
        ::pread(file, bytes.data() + have, bytes.size() - have, begin + static_cast<off_t>(have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    have += std::size_t(got);
  }
  bytes.resize(have);
  ::close(file);
  return bytes;
}

int wake_writer = -1;  // the handler's end of a pipe

void child_has_ended(int) {
  const int before = errno;
  [[maybe_unused]] const auto written = ::write(wake_writer, "!", 1);
  errno = before;
}

struct Running {
  std::uint64_t id = 0;
  double begin = 0, deadline = 0;  // 0: none
  int told = -1, printed = -1;
  bool timed_out = false;
};

void call(const std::function<void()>& hook) {
  if (hook) hook();
}

/// The server's side, in its own process.
class Server {
 public:
  Server(int socket, const ForkServer::Work& work, const ForkServer::Hooks& hooks)
      : socket_(socket), work_(work), hooks_(hooks) {}

  [[noreturn]] void run() {
    ::setpgid(0, 0);  // requests to stop from a terminal are for the process that made this one
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(signal, SIG_IGN);
    int wake[2];
    if (::pipe(wake) != 0) ::_exit(1);
    for (const int end : wake) ::fcntl(end, F_SETFL, O_NONBLOCK);
    wake_reader_ = wake[0];
    wake_writer = wake[1];
    struct sigaction action = {};
    action.sa_handler = child_has_ended;
    action.sa_flags = SA_RESTART | SA_NOCLDSTOP;
    ::sigaction(SIGCHLD, &action, nullptr);
    while (true) {
      const int answers = unsent_.empty() ? 0 : POLLOUT;
      pollfd ready[2] = {{socket_, static_cast<short>(POLLIN | answers), 0},
                         {wake_reader_, POLLIN, 0}};
      ::poll(ready, 2, milliseconds_to_next_deadline());
      char bytes[64];
      while (::read(wake_reader_, bytes, sizeof bytes) > 0) {
      }
      collect();
      end_overdue();
      send_what_fits();
      if ((ready[0].revents & (POLLIN | POLLHUP | POLLERR)) != 0) accept();
    }
  }

 private:
  int milliseconds_to_next_deadline() const {
    double next = 0;
    for (const auto& [pid, child] : running_)
      if (child.deadline > 0 && !child.timed_out && (next == 0 || child.deadline < next))
        next = child.deadline;
    if (next == 0) return -1;
    return static_cast<int>(std::clamp((next - now()) * 1000 + 1, 0.0, 1e9));
  }

  void end_overdue() {
    for (auto& [pid, child] : running_) {
      if (child.deadline == 0 || child.timed_out || now() < child.deadline) continue;
      child.timed_out = true;
      ::kill(-pid, SIGKILL);
      ::kill(pid, SIGKILL);  // its group may not exist yet
    }
  }

  /// Children that have ended.
  void collect() {
    int state = 0;
    struct rusage usage = {};
    for (pid_t pid; (pid = ::wait4(-1, &state, WNOHANG, &usage)) > 0;) {
      const auto found = running_.find(pid);
      if (found == running_.end()) continue;
      ::kill(-pid, SIGKILL);  // what it started and left behind
      const Running child = found->second;
      running_.erase(found);
      ForkEnd end;
      end.id = child.id;
      end.timed_out = child.timed_out;
      if (WIFSIGNALED(state)) end.signal = WTERMSIG(state);
      end.seconds = now() - child.begin;
      end.peak_memory = 1024.0 * static_cast<double>(usage.ru_maxrss);
      end.told = take_file(child.told, off_t{1} << 26);
      end.printed = take_file(child.printed, 4096);
      if (end.told.size() >= sizeof(double)) {
        double began = 0;
        end.told.copy(reinterpret_cast<char*>(&began), sizeof began);
        end.start_seconds = began - child.begin;
        end.told.erase(0, sizeof began);
      }
      answer(end);
    }
  }

  void answer(const ForkEnd& end) {
    Message message;
    message.add(end.id).add(end.signal).add(end.timed_out).add(end.not_started);
    message.add(end.told).add(end.printed).add(end.seconds).add(end.start_seconds);
    message.add(end.peak_memory).append_to(unsent_);
  }

  /// Never waits: whoever asks may be sending a request, and reads no answer until that is through.
  void send_what_fits() {
    while (sent_ < unsent_.size()) {
      const ssize_t sent = ::send(socket_, unsent_.data() + sent_, unsent_.size() - sent_,
                                  MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
      if (sent <= 0) finish();
      sent_ += std::size_t(sent);
    }
    unsent_.clear();
    sent_ = 0;
  }

  void accept() {
    Message message;
    if (!message.receive(socket_)) finish();
    Running child;
    ForkLimits limits;
    std::string request;
    message.take(child.id);
    message.take(limits);
    message.take(request);
    child.begin = now();
    if (limits.seconds > 0) child.deadline = child.begin + limits.seconds;
    child.told = memory_file();
    child.printed = memory_file();
    call(hooks_.before);
    const pid_t pid = child.told < 0 || child.printed < 0 ? -1 : ::fork();
    if (pid == 0) become(child, limits, request);
    const int error = errno;
    call(hooks_.in_parent);
    if (pid > 0) {
      running_[pid] = child;
      return;
    }
    for (const int file : {child.told, child.printed})
      if (file >= 0) ::close(file);
    ForkEnd end;
    end.id = child.id;
    // There is one thread. Under sanitizers a virtual call opens files, and there may be no room.
    end.not_started = std::string("cannot start a process: ") + std::strerror(error);
    answer(end);
  }

  [[noreturn]] void become(const Running& self, const ForkLimits& limits,
                           const std::string& request) {
    for (const int end : {socket_, wake_reader_, wake_writer}) ::close(end);
    for (const auto& [pid, other] : running_) {
      ::close(other.told);
      ::close(other.printed);
    }
    if (!begin_child(self.printed)) ::_exit(1);
    limit_memory(MemoryKind::data, limits.memory > 0 ? limits.memory + writable_memory() : 0);
    call(hooks_.in_child);
    const auto tell = [&](std::string_view bytes) { write_all(self.told, bytes); };
    const double began = now();
    tell({reinterpret_cast<const char*>(&began), sizeof began});
    try {
      work_(request, tell);
    } catch (...) {
      ::_exit(1);
    }
    std::cout.flush();
    std::fflush(nullptr);
    ::_exit(0);
  }

  [[noreturn]] void finish() {
    for (const auto& [pid, child] : running_) {
      ::kill(-pid, SIGKILL);
      ::kill(pid, SIGKILL);
    }
    for (std::size_t left = running_.size(); left > 0; --left)
      while (::wait(nullptr) < 0 && errno == EINTR) {
      }
    ::_exit(0);
  }

  int socket_, wake_reader_ = -1;
  const ForkServer::Work& work_;
  const ForkServer::Hooks& hooks_;
  std::map<pid_t, Running> running_;
  std::string unsent_;  // answers, the first `sent_` bytes of which are on their way
  std::size_t sent_ = 0;
};

[[noreturn]] void throw_gone() {
  throw IoError("the process that starts all others has ended; run again to go on", "system");
}

}  // namespace

ForkServer::ForkServer(Work work, Hooks hooks) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
    throw IoError("cannot start a process: " + std::generic_category().message(errno), "system");
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  std::cout.flush();
  std::fflush(nullptr);
  call(hooks.before);
  server_ = ::fork();
  if (server_ == 0) {
    ::close(ends[0]);
    call(hooks.in_child);
    Server(ends[1], work, hooks).run();
  }
  const int error = errno;
  call(hooks.in_parent);
  ::close(ends[1]);
  socket_ = ends[0];
  if (server_ > 0) return;
  ::close(socket_);
  throw IoError("cannot start a process: " + std::generic_category().message(error), "system");
}

ForkServer::~ForkServer() {
  ::close(socket_);
  while (::waitpid(server_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void ForkServer::start(std::uint64_t id, const std::string& request,
                       const ForkLimits& limits) const {
  if (!Message().add(id).add(limits).add(request).send(socket_)) throw_gone();
}

std::optional<ForkEnd> ForkServer::wait(double seconds) const {
  pollfd ready = {socket_, POLLIN, 0};
  const int got = ::poll(&ready, 1, static_cast<int>(std::clamp(seconds * 1000, 0.0, 1e9)));
  if (got <= 0) return std::nullopt;
  Message message;
  if (!message.receive(socket_)) throw_gone();
  ForkEnd end;
  message.take(end.id);
  message.take(end.signal);
  message.take(end.timed_out);
  message.take(end.not_started);
  message.take(end.told);
  message.take(end.printed);
  message.take(end.seconds);
  message.take(end.start_seconds);
  message.take(end.peak_memory);
  return end;
}

}  // namespace littoral
