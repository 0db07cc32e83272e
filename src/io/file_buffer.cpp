#include "io/file_buffer.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <utility>

#include "base/parallel.h"

namespace littoral::io {

namespace {
constexpr std::size_t piece = 1 << 20;  // bytes
constexpr std::size_t much = 8 * piece;
}  // namespace

FileBuffer::FileBuffer(std::string path) : path_(std::move(path)) {
  open(path_, std::ios::out | std::ios::binary | std::ios::trunc);
}

std::streamsize FileBuffer::xsputn(const char* bytes, std::streamsize n) {
  const auto size = static_cast<std::size_t>(std::max<std::streamsize>(n, 0));
  if (size < much || thread_count() == 1) return std::filebuf::xsputn(bytes, n);
  if (!places_) places_ = std::make_unique<FilePlaces>(path_.c_str(), FilePlaces::For::writing);
  if (!places_->is_open() || pubsync() != 0) return std::filebuf::xsputn(bytes, n);
  const std::streamoff begin = pubseekoff(0, std::ios::cur, std::ios::out);
  if (begin < 0) return std::filebuf::xsputn(bytes, n);
  std::atomic<int> error{0};
  parallel_for(size, piece, [&](std::size_t first, std::size_t end) {
    if (error == 0)
      if (const int e = places_->write(bytes + first, end - first, begin + std::streamoff(first)))
        error = e;
  });
  if (error == 0 && pubseekoff(begin + n, std::ios::beg, std::ios::out) == begin + n) return n;
  if (error != 0) errno = error;
  return 0;
}

}  // namespace littoral::io
