#pragma once
// A file that one process at a time writes to.

#include <filesystem>

namespace littoral {

/// Holds a lock on a file, which is made where there is none, as long as it lives; the system lets
/// go of it when the process ends, however it does.
class FileLock {
 public:
  /// Throws IoError naming the file where it cannot be written to or somebody else holds it.
  explicit FileLock(const std::filesystem::path& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_;
};

}  // namespace littoral
