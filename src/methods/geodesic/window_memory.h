#pragma once
// Where the windows of a search lie.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/large_vector.h"
#include "methods/geodesic/window_block.h"

namespace littoral {

/// Pieces of memory for blocks, of few sizes, cut from pages that each have pieces of one size
/// until all of them are back. What one thread has too much of goes to others by way of this; all
/// of it ends with it. The allocator of the system takes longer, above all where two threads free
/// what lies side by side.
class WindowMemory {
 public:
  /// Windows a piece has room for: 1, 5, 9, 13, 17, 25, 33, 41, 49, 65, ...
  static std::size_t room_of(std::size_t size) { return stride_of(size) - WindowBlock::spare; }
  /// The least size with room for n windows: strides of 4 ((4 + r) 2^k - 3) numbers for r of 0
  /// to 3.
  static std::size_t size_for(std::size_t n) {
    const std::size_t least = (n + WindowBlock::spare + 3) / 4 + 3;
    const std::size_t k = std::size_t(std::bit_width(least)) - 3;  // 4 2^k <= least < 8 2^k
    return 4 * k + ((least - 1) >> k) - 3;
  }
  /// An odd number of fours for all but small ones, so that columns do not lie in the same places
  /// of the processor's cache.
  static std::size_t stride_of(std::size_t size) {
    return 4 * (((4 + size % 4) << (size / 4)) - 3);
  }
  /// So many pieces of a size change hands at once.
  static std::size_t bundle(std::size_t size) {
    return std::max<std::size_t>(1, bundle_lines / stride_of(size));
  }

  /// Adds a bundle of pieces.
  void take(std::size_t size, std::vector<double*>& to) {
    const std::lock_guard lock(mutex_);
    const std::size_t lines = stride_of(size);
    if (lines > most_cut) {
      LargeVector<Line> piece(lines);
      to.push_back(piece[0].numbers);
      large_.emplace(to.back(), std::move(piece));
      return;
    }
    if (with_free_.size() <= size) with_free_.resize(size + 1);
    std::vector<Page*>& pages = with_free_[size];
    for (std::size_t i = bundle(size); i-- > 0;) {
      if (pages.empty()) pages.push_back(&cut(size));
      Page& page = *pages.back();
      to.push_back(page.lines[1 + page.free.back() * lines].numbers);
      page.free.pop_back();
      if (page.free.empty()) pages.pop_back();
    }
  }
  /// Takes back the first n of some pieces, those that have not been used for longest.
  void give(std::size_t size, std::vector<double*>& from, std::size_t n) {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < n; ++i) {
      if (stride_of(size) > most_cut)
        large_.erase(from[i]);
      else
        give_piece(size, from[i]);
    }
    from.erase(from.begin(), from.begin() + index(n));
  }
  /// What it has from the system, without large pieces.
  double bytes() const { return double(pages_.size()) * sizeof(PageMemory); }

 private:
  struct alignas(64) Line {
    double numbers[8];
  };
  static constexpr std::size_t page_lines = 4096;  // 256 KiB
  static constexpr std::size_t bundle_lines = 256;
  static constexpr std::size_t most_cut = 512;   // lines; larger pieces come and go alone
  static constexpr std::size_t most_pages = 16;  // from the system at once
  struct alignas(page_lines * sizeof(Line)) PageMemory {
    Line lines[page_lines];
  };
  /// Pieces of one size behind a first line that says whose they are.
  struct Page {
    Line* lines = nullptr;
    std::vector<std::uint16_t> free;  // pieces
  };
  static std::size_t pieces(std::size_t size) { return (page_lines - 1) / stride_of(size); }

  /// A page all of whose pieces are free; one that other pieces have left where there is one.
  Page& cut(std::size_t size) {
    if (unused_.empty()) {
      slabs_.emplace_back(std::clamp<std::size_t>(pages_.size(), 1, most_pages));
      for (PageMemory& memory : slabs_.back()) {
        unused_.push_back(&pages_.emplace_back());
        pages_.back().lines = memory.lines;
      }
      std::reverse(unused_.begin(), unused_.end());
    }
    Page& page = *unused_.back();
    unused_.pop_back();
    *reinterpret_cast<Page**>(page.lines) = &page;
    page.free.resize(pieces(size));
    std::iota(page.free.rbegin(), page.free.rend(), std::uint16_t(0));
    return page;
  }
  void give_piece(std::size_t size, double* piece) {
    constexpr std::uintptr_t within = sizeof(PageMemory) - 1;
    Page& page = **reinterpret_cast<Page**>(reinterpret_cast<std::uintptr_t>(piece) & ~within);
    const std::size_t line = std::size_t(reinterpret_cast<Line*>(piece) - page.lines);
    std::vector<Page*>& pages = with_free_[size];
    if (page.free.empty()) pages.push_back(&page);
    page.free.push_back(std::uint16_t(line / stride_of(size)));
    if (page.free.size() < pieces(size)) return;
    std::erase(pages, &page);
    unused_.push_back(&page);
  }

  std::mutex mutex_;
  std::vector<LargeVector<PageMemory>> slabs_;
  std::deque<Page> pages_;
  std::vector<Page*> unused_;
  std::vector<std::vector<Page*>> with_free_;  // by size
  std::unordered_map<double*, LargeVector<Line>> large_;
};

/// Blocks as one thread needs and leaves them: most live shortly.
class SpareBlocks {
 public:
  explicit SpareBlocks(WindowMemory& memory) : memory_(memory) {}
  ~SpareBlocks() {
    for (std::size_t size = 0; size < spare_.size(); ++size)
      memory_.give(size, spare_[size], spare_[size].size());
  }
  SpareBlocks(const SpareBlocks&) = delete;
  SpareBlocks& operator=(const SpareBlocks&) = delete;

  /// An empty block with room for n windows.
  WindowBlock take(std::size_t n) {
    const std::size_t size = WindowMemory::size_for(n);
    std::vector<double*>& spare = of_size(size);
    if (spare.empty()) memory_.take(size, spare);
    WindowBlock block(spare.back(), WindowMemory::stride_of(size));
    spare.pop_back();
    return block;
  }
  void give(WindowBlock&& given) {
    const WindowBlock block = std::move(given);
    if (block.room() == 0) return;
    const std::size_t size = WindowMemory::size_for(block.room());
    std::vector<double*>& spare = of_size(size);
    spare.push_back(block.memory());
    const std::size_t most = most_bundles * WindowMemory::bundle(size);
    if (spare.size() > most) memory_.give(size, spare, most / 2 + 1);
  }

  /// Lets a block have room for n windows and, if it needs more for that, for half as many more.
  void make_room(WindowBlock& block, std::size_t n) {
    if (n <= block.room()) return;
    WindowBlock larger = take(n > 5 ? n + n / 2 : n);
    larger.append(block, 0, block.size());
    give(std::exchange(block, std::move(larger)));
  }
  void push_back(WindowBlock& block, const Window& w) {
    make_room(block, block.size() + 1);
    block.resize(block.size() + 1);
    block.set(block.size() - 1, w);
  }
  /// Makes room for n windows in front of window `at`.
  void insert(WindowBlock& block, std::size_t at, std::size_t n) {
    make_room(block, block.size() + n);
    block.shift(at, std::ptrdiff_t(n));
  }

 private:
  static constexpr std::size_t most_bundles = 4;

  std::vector<double*>& of_size(std::size_t size) {
    if (spare_.size() <= size) spare_.resize(size + 1);
    return spare_[size];
  }

  WindowMemory& memory_;
  std::vector<std::vector<double*>> spare_;  // by size
};

}  // namespace littoral
