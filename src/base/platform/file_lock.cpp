#include "base/platform/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "littoral/error.h"

namespace littoral {

FileLock::FileLock(const std::filesystem::path& path)
    : file_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (file_ < 0)
    throw IoError("cannot write " + path.string() + ": " + std::generic_category().message(errno),
                  "cannot-write");
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  // File systems without locks: then there is none.
  if (error != EWOULDBLOCK) return;
  ::close(file_);
  throw IoError("another batch is writing " + path.string(), "cannot-write");
}

FileLock::~FileLock() { ::close(file_); }

}  // namespace littoral
