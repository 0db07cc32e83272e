#include "base/platform/child_process.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <thread>

#include "base/now_and_then.h"
#include "base/platform/child_start.h"
#include "base/platform/memory.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr int not_started = 127;

std::string last_line(const std::filesystem::path& file) {
  constexpr std::streamoff most = 4096;
  std::ifstream in(file, std::ios::binary);
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  if (size <= 0) return {};
  in.seekg(std::max<std::streamoff>(0, size - most));
  return last_line_of(std::string(std::istreambuf_iterator<char>(in), {}));
}

/// What the child does before it becomes another program: only calls that are safe in a copy of a
/// process with several threads.
[[noreturn]] void become(const char* program, char* const* arguments, const char* folder,
                         const char* output, double memory) {
  const int out = ::open(output, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (!begin_child(out)) ::_exit(not_started);
  limit_memory(MemoryKind::address_space, memory);
  if (::chdir(folder) == 0) ::execv(program, arguments);
  ::_exit(not_started);
}

/// A running child; ended, with all it started, unless it has ended by itself.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() { end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Has it ended? `state` is then what waitpid says.
  bool has_ended(int& state) {
    const pid_t got = ::waitpid(pid_, &state, WNOHANG);
    if (got == 0 || (got < 0 && errno == EINTR)) return false;
    ::kill(-pid_, SIGKILL);  // what it started and left behind
    running_ = false;
    return true;
  }
  void end() {
    if (!running_) return;
    // Its group may not exist yet.
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
    running_ = false;
  }

 private:
  pid_t pid_;
  bool running_ = true;
};

}  // namespace

std::string last_line_of(std::string_view output) {
  std::string last;
  while (!output.empty()) {
    const std::string_view line = output.substr(0, output.find('\n'));
    output.remove_prefix(std::min(line.size() + 1, output.size()));
    std::string text;
    for (const char c : line)
      if (c >= ' ' && c <= '~') text += c;
    if (text.find_first_not_of(' ') != std::string::npos) last = text.substr(0, 200);
  }
  return last;
}

std::optional<std::filesystem::path> find_program(const std::string& name) {
  const auto is_program = [](const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
  };
  if (name.find('/') != std::string::npos) {
    if (is_program(name)) return std::filesystem::absolute(name);
    return std::nullopt;
  }
  const char* value = std::getenv("PATH");
  std::string_view folders = value != nullptr ? value : "/usr/local/bin:/usr/bin:/bin";
  while (!folders.empty()) {
    const std::size_t end = std::min(folders.find(':'), folders.size());
    const std::filesystem::path folder(folders.substr(0, end));
    if (!folder.empty() && is_program(folder / name))
      return std::filesystem::absolute(folder / name);
    folders.remove_prefix(std::min(end + 1, folders.size()));
  }
  return std::nullopt;
}

ChildEnd run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const std::filesystem::path& folder, double timeout, const Task& task) {
  task.checkpoint();
  const std::string path = program.string(), where = folder.string();
  const std::string output = (folder / "output").string();
  std::vector<std::string> words{path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const double memory = available_memory();

  const pid_t pid = ::fork();
  if (pid < 0)
    throw IoError("cannot start " + path + ": " + std::generic_category().message(errno), "system");
  if (pid == 0) become(path.c_str(), pointers.data(), where.c_str(), output.c_str(), memory);
  Child child(pid);
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  int state = 0;
  ChildEnd result;
  while (!child.has_ended(state)) {
    stop_if_cancelled(task);
    if (std::chrono::duration<double>(Clock::now() - begin).count() > timeout) {
      child.end();
      result.timed_out = true;
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  result.said = last_line(output);
  if (result.timed_out) return result;
  if (WIFSIGNALED(state)) result.signal = WTERMSIG(state);
  if (WIFEXITED(state)) result.status = WEXITSTATUS(state);
  return result;
}

}  // namespace littoral
