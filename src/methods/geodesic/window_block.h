#pragma once
// Windows of one edge, column by column, so that several are read and written at once.

#include <cstdint>
#include <cstring>
#include <utility>

#include "base/fetch_ahead.h"
#include "methods/geodesic/polyhedral_window.h"

namespace littoral {

/// What a window is beside its numbers, as one number.
struct WindowTag {
  static constexpr std::int64_t page_one = std::int64_t(1) << 32, page_all = 65535 * page_one,
                                depth_one = std::int64_t(1) << 48, depth_all = 255 * depth_one,
                                parallel = std::int64_t(1) << 56, open = std::int64_t(1) << 57;

  static std::int64_t of(const Window& w) {
    return std::int64_t(std::uint32_t(w.source)) | w.page * page_one | w.depth * depth_one |
           (w.parallel ? parallel : 0) | (w.open ? open : 0);
  }
  static void say(std::int64_t tag, Window& w) {
    w.source = int(std::uint32_t(tag));
    w.page = std::uint16_t(tag >> 32);
    w.depth = std::uint8_t(tag >> 48);
    w.parallel = (tag & parallel) != 0;
    w.open = (tag & open) != 0;
  }
};

/// A vector of windows: eight columns of one piece of memory, which is somebody else's
/// (`WindowMemory`). A few numbers beyond the last window of every column may be read and written.
class WindowBlock {
 public:
  static constexpr std::size_t spare = 3;
  enum Column { b0, b1, d0, d1, x, y, behind, n_numbers };

  WindowBlock() = default;
  WindowBlock(double* memory, std::size_t stride) : data_(memory), stride_(std::uint32_t(stride)) {}
  WindowBlock(WindowBlock&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        stride_(std::exchange(other.stride_, 0)) {}
  WindowBlock& operator=(WindowBlock&& other) noexcept {
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
    stride_ = std::exchange(other.stride_, 0);
    return *this;
  }

  std::size_t size() const { return size_; }
  std::size_t room() const { return stride_ > spare ? stride_ - spare : 0; }
  bool empty() const { return size_ == 0; }
  double* memory() const { return data_; }
  double* column(Column c) { return data_ + c * std::size_t(stride_); }
  const double* column(Column c) const { return data_ + c * std::size_t(stride_); }
  /// `WindowTag`s.
  std::int64_t* tags() { return tags_of(data_, stride_); }
  const std::int64_t* tags() const { return tags_of(data_, stride_); }

  Window operator[](std::size_t i) const {
    Window w;
    const double* from = data_ + i;
    const std::size_t s = stride_;
    w.b0 = from[b0 * s];
    w.b1 = from[b1 * s];
    w.d0 = from[d0 * s];
    w.d1 = from[d1 * s];
    w.x = from[x * s];
    w.y = from[y * s];
    w.behind = from[behind * s];
    WindowTag::say(tags()[i], w);
    return w;
  }
  Window back() const { return (*this)[size_ - 1]; }
  void set(std::size_t i, const Window& w) {
    double* to = data_ + i;
    const std::size_t s = stride_;
    to[b0 * s] = w.b0;
    to[b1 * s] = w.b1;
    to[d0 * s] = w.d0;
    to[d1 * s] = w.d1;
    to[x * s] = w.x;
    to[y * s] = w.y;
    to[behind * s] = w.behind;
    tags()[i] = WindowTag::of(w);
  }

  /// Lets the processor read it ahead of time.
  void fetch() const {
    if (stride_ <= line) {
      for (std::size_t i = 0; i < stride_; ++i) fetch_ahead(data_ + i * line);
      return;
    }
    for (std::size_t i = 0; i < size_; i += line)
      for (std::size_t c = 0; c <= n_numbers; ++c) fetch_ahead(data_ + c * stride_ + i);
  }
  /// Within its room, as all that follow. The last ones may be left unset.
  void resize(std::size_t n) { size_ = std::uint32_t(n); }
  void pop_back() { --size_; }
  /// Makes place for n windows in front of window `at`, or takes away -n from there on.
  void shift(std::size_t at, std::ptrdiff_t n) {
    const std::size_t from = n < 0 ? at + std::size_t(-n) : at, moved = size_ - from;
    resize(std::size_t(std::ptrdiff_t(size_) + n));
    if (moved == 0) return;
    for (std::size_t c = 0; c <= n_numbers; ++c) {
      double* const column = data_ + c * stride_;
      std::memmove(column + std::ptrdiff_t(from) + n, column + from, moved * sizeof(double));
    }
  }
  /// Windows first, ..., last - 1 of another block, at the end of this one, which has room.
  void append(const WindowBlock& from, std::size_t first, std::size_t last) {
    const std::size_t n = last - first;
    for (std::size_t c = 0; c <= n_numbers; ++c) {
      double* to = data_ + c * stride_ + size_;
      const double* read = from.data_ + c * from.stride_ + first;
      for (std::size_t i = 0; i < n; i += 4) std::memcpy(to + i, read + i, 4 * sizeof *to);
    }
    size_ += std::uint32_t(n);
  }

 private:
  static constexpr std::size_t line = 8;  // numbers in a line of the cache

  static std::int64_t* tags_of(double* data, std::size_t stride) {
    static_assert(sizeof(double) == sizeof(std::int64_t));
    return reinterpret_cast<std::int64_t*>(data + n_numbers * stride);
  }

  double* data_ = nullptr;
  std::uint32_t size_ = 0, stride_ = 0;
};

}  // namespace littoral
