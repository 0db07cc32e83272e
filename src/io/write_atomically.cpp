#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <system_error>

#include "base/platform/process.h"
#include "io/file_buffer.h"
#include "io/formats.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

// Names of temporary files in fixed storage, where a signal handler can read them at any time.
struct Slot {
  enum State : int { empty, claimed, named };
  std::atomic<int> state{empty};
  std::array<char, 4096> path{};
};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<Slot, 32> slots;

// A temporary file's entry in the table, and the file itself unless it was kept.
class Unfinished {
 public:
  explicit Unfinished(std::string path) : path_(std::move(path)) {
    if (path_.size() >= slots[0].path.size()) return;
    for (Slot& slot : slots) {
      int expected = Slot::empty;
      if (!slot.state.compare_exchange_strong(expected, Slot::claimed)) continue;
      std::memcpy(slot.path.data(), path_.c_str(), path_.size() + 1);
      slot.state = Slot::named;
      slot_ = &slot;
      return;
    }
  }
  ~Unfinished() {
    if (!kept_) remove_file(path_.c_str());
    if (slot_) slot_->state = Slot::empty;
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  void keep() { kept_ = true; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  Slot* slot_ = nullptr;
  bool kept_ = false;
};

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw IoError("cannot write " + path.string() + ": " + std::generic_category().message(error),
                "cannot-write");
}

/// Through a buffer of a file; path is named where it fails.
void write_through(std::filebuf& buffer, const std::filesystem::path& path,
                   const std::function<void(std::ostream&)>& body) {
  if (!buffer.is_open()) fail(path, errno ? errno : EIO);
  std::ostream out(&buffer);
  errno = 0;
  body(out);
  const int error = out ? 0 : errno;
  errno = 0;
  if (buffer.close() == nullptr || !out) fail(path, error ? error : errno ? errno : EIO);
}

void write_file(const std::filesystem::path& path, const std::string& file,
                const std::function<void(std::ostream&)>& body) {
  errno = 0;
  FileBuffer buffer(file);
  write_through(buffer, path, body);
}

/// To what is not a file: a device, a pipe.
void write_stream(const std::filesystem::path& path,
                  const std::function<void(std::ostream&)>& body) {
  errno = 0;
  std::filebuf buffer;
  buffer.open(path.string(), std::ios::out | std::ios::binary | std::ios::trunc);
  write_through(buffer, path, body);
}

std::string temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> counter{0};
  std::string name(1, '.');
  name.append(target.filename().string()).append(1, '.').append(std::to_string(process_id()));
  name.append(1, '-').append(std::to_string(counter++)).append(".tmp");
  return (target.parent_path() / name).string();
}

/// All or nothing, as files are.
void write_to_standard_output(const std::filesystem::path& path,
                              const std::function<void(std::ostream&)>& body) {
  std::ostringstream whole;
  body(whole);
  const std::string bytes = std::move(whole).str();
  errno = 0;
  // Not by operator<<, which takes a part that was written for success.
  std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
  if (!std::cout) fail(path, errno ? errno : EIO);
}

/// Throws where the folder of a file to be written is missing.
void check_folder(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path folder = path.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, error))
    throw IoError("cannot write " + path.string() + ": there is no folder " + folder.string(),
                  "cannot-write");
}

}  // namespace

void write_atomically(const std::filesystem::path& path,
                      const std::function<void(std::ostream&)>& body) {
  if (is_standard_stream(path)) return write_to_standard_output(path, body);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail(path, EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    write_stream(path, body);
    return;
  }
  check_folder(path);
  const std::filesystem::path resolved = std::filesystem::weakly_canonical(path, error);
  const std::filesystem::path& target = error ? path : resolved;
  Unfinished temporary(temporary_name(target));
  write_file(path, temporary.path(), body);
  std::filesystem::rename(temporary.path(), target, error);
  if (error) fail(path, error.value());
  temporary.keep();
}

void check_writable(const std::filesystem::path& path) {
  if (is_standard_stream(path)) return;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail(path, EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return;
  check_folder(path);
  const std::filesystem::path resolved = std::filesystem::weakly_canonical(path, error);
  const Unfinished probe(temporary_name(error ? path : resolved));
  write_file(path, probe.path(), [](std::ostream&) {});
}

void remove_unfinished_files() noexcept {
  for (Slot& slot : slots) {
    if (slot.state == Slot::named) remove_file(slot.path.data());
  }
}

}  // namespace littoral::io
