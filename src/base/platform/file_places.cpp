#include "base/platform/file_places.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace littoral {

FilePlaces::FilePlaces(const char* path, For use) noexcept
    : file_(::open(path, (use == For::reading ? O_RDONLY : O_WRONLY) | O_CLOEXEC)) {}

FilePlaces::~FilePlaces() {
  if (file_ >= 0) ::close(file_);
}

int FilePlaces::write(const char* bytes, std::size_t n, long long place) noexcept {
  while (n > 0) {
    const auto written = ::pwrite(file_, bytes, n, static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    bytes += written;
    place += written;
    n -= static_cast<std::size_t>(written);
  }
  return 0;
}

std::size_t FilePlaces::read(char* bytes, std::size_t n, long long place, int& error) noexcept {
  std::size_t done = 0;
  while (done < n) {
    const auto got = ::pread(file_, bytes + done, n - done,
                             static_cast<off_t>(place + static_cast<long long>(done)));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) error = errno;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

}  // namespace littoral
