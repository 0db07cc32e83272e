#pragma once
// Windows of one edge, column by column, so that several are read and written at once.

#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

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

/// A vector of windows: eight columns of one piece of memory. A few numbers beyond the last window
/// of every column may be read and written.
class WindowBlock {
 public:
  static constexpr std::size_t spare = 4;
  enum Column { b0, b1, d0, d1, x, y, behind, n_numbers };

  WindowBlock() = default;
  WindowBlock(WindowBlock&& other) noexcept
      : data_(std::move(other.data_)),
        size_(std::exchange(other.size_, 0)),
        stride_(std::exchange(other.stride_, 0)) {}
  WindowBlock& operator=(WindowBlock&& other) noexcept {
    data_ = std::move(other.data_);
    size_ = std::exchange(other.size_, 0);
    stride_ = std::exchange(other.stride_, 0);
    return *this;
  }

  std::size_t size() const { return size_; }
  std::size_t room() const { return stride_ > spare ? stride_ - spare : 0; }
  bool empty() const { return size_ == 0; }
  double* column(Column c) { return data_.get() + c * std::size_t(stride_); }
  const double* column(Column c) const { return data_.get() + c * std::size_t(stride_); }
  /// `WindowTag`s.
  std::int64_t* tags() { return tags_of(data_.get(), stride_); }
  const std::int64_t* tags() const { return tags_of(data_.get(), stride_); }

  Window operator[](std::size_t i) const {
    Window w;
    const double* from = data_.get() + i;
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
    double* to = data_.get() + i;
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
    for (std::size_t i = 0; i < size_; i += 8)
      for (std::size_t c = 0; c <= n_numbers; ++c) fetch_ahead(data_.get() + c * stride_ + i);
  }
  void clear() { size_ = 0; }
  /// Room for so many windows, no more.
  void reserve(std::size_t n) {
    if (n + spare <= stride_) return;
    Memory larger = memory(n + spare);
    move_columns(larger.get(), n + spare, 0, data_.get(), stride_, 0, size_);
    data_ = std::move(larger);
    stride_ = std::uint32_t(n + spare);
  }
  /// The last ones may be left unset.
  void resize(std::size_t n) {
    if (n + spare > stride_) reserve(n > 8 ? n + n / 2 : 8);
    size_ = std::uint32_t(n);
  }
  void push_back(const Window& w) {
    resize(size_ + 1);
    set(size_ - 1, w);
  }
  void pop_back() { --size_; }
  /// Makes room for n windows in front of window `at`, or takes away -n from there on.
  void shift(std::size_t at, std::ptrdiff_t n) {
    const std::size_t from = n < 0 ? at + std::size_t(-n) : at, moved = size_ - from;
    resize(std::size_t(std::ptrdiff_t(size_) + n));
    move_columns(data_.get(), stride_, std::size_t(std::ptrdiff_t(from) + n), data_.get(), stride_,
                 from, moved);
  }
  /// Windows first, ..., last - 1 of another block, at the end of this one, which has room.
  void append(const WindowBlock& from, std::size_t first, std::size_t last) {
    const std::size_t n = last - first;
    for (std::size_t c = 0; c <= n_numbers; ++c) {
      double* to = data_.get() + c * stride_ + size_;
      const double* read = from.data_.get() + c * from.stride_ + first;
      for (std::size_t i = 0; i < n; i += spare) std::memcpy(to + i, read + i, spare * sizeof *to);
    }
    size_ += std::uint32_t(n);
  }

 private:
  struct Free {
    void operator()(double* p) const { ::operator delete(p); }
  };
  using Memory = std::unique_ptr<double, Free>;

  static Memory memory(std::size_t stride) {
    static_assert(sizeof(double) == sizeof(std::int64_t));
    return Memory(static_cast<double*>(::operator new((n_numbers + 1) * stride * sizeof(double))));
  }
  static std::int64_t* tags_of(double* data, std::size_t stride) {
    return reinterpret_cast<std::int64_t*>(data + n_numbers * stride);
  }
  static void move_columns(double* to, std::size_t to_stride, std::size_t to_first,
                           const double* from, std::size_t from_stride, std::size_t first,
                           std::size_t n) {
    if (n == 0) return;
    for (std::size_t c = 0; c <= n_numbers; ++c)
      std::memmove(to + c * to_stride + to_first, from + c * from_stride + first,
                   n * sizeof(double));
  }

  Memory data_;
  std::uint32_t size_ = 0, stride_ = 0;
};

/// Blocks that are not in use, by how much they have room for: most live shortly.
class SpareBlocks {
 public:
  std::size_t most_room = 30000;  // windows, in all of them

  /// An empty block with room for n windows.
  WindowBlock take(std::size_t n) {
    const std::size_t size = size_for(n);
    WindowBlock block;
    if (size < spare_.size() && !spare_[size].empty()) {
      block = std::move(spare_[size].back());
      spare_[size].pop_back();
      block.clear();
      room_ -= block.room();
    } else {
      block.reserve(room_of(size));
    }
    return block;
  }
  void give(WindowBlock&& given) {
    WindowBlock block = std::move(given);
    if (block.room() < least_room || room_ + block.room() > most_room) return;
    room_ += block.room();
    std::size_t size = size_for(block.room());
    if (room_of(size) > block.room()) --size;
    if (size >= spare_.size()) spare_.resize(size + 1);
    spare_[size].push_back(std::move(block));
  }

 private:
  static constexpr std::size_t least_room = 4;  // windows

  /// 4, 6, 8, 12, 16, ...
  static std::size_t room_of(std::size_t size) {
    return (size % 2 == 0 ? least_room : least_room + least_room / 2) << (size / 2);
  }
  static std::size_t size_for(std::size_t n) {
    if (n <= least_room) return 0;
    const std::size_t size = 2 * std::size_t(std::bit_width(n - 1)) - 4;
    return room_of(size - 1) < n ? size : size - 1;
  }

  std::vector<std::vector<WindowBlock>> spare_;
  std::size_t room_ = 0;  // in all of them
};

}  // namespace littoral
