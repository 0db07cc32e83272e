// Windows column by column are what they were one by one.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "methods/geodesic/window_memory.h"

namespace littoral {
namespace {

Window window_of(int i) {
  Window w;
  w.b0 = i;
  w.b1 = i + 0.5;
  w.d0 = i + 10;
  w.d1 = i + 20;
  w.x = i + 30;
  w.y = -i;
  w.behind = i + 40;
  w.source = i - 2;  // -1: none
  w.page = std::uint16_t(i % 3 == 0 ? Window::no_page : i);
  w.depth = std::uint8_t(i % 256);
  w.parallel = i % 2 != 0;
  w.open = i % 5 != 0;
  return w;
}

void expect_same(const Window& a, const Window& b) {
  EXPECT_EQ(a.b0, b.b0);
  EXPECT_EQ(a.b1, b.b1);
  EXPECT_EQ(a.d0, b.d0);
  EXPECT_EQ(a.d1, b.d1);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.behind, b.behind);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.page, b.page);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.parallel, b.parallel);
  EXPECT_EQ(a.open, b.open);
}

TEST(WindowBlock, AsAVectorOfWindows) {
  std::mt19937 random(3);
  std::vector<Window> expected;
  WindowMemory memory;
  SpareBlocks spare(memory);
  WindowBlock block;
  for (int step = 0; step < 2000; ++step) {
    const std::size_t n = expected.size(), at = n == 0 ? 0 : random() % n;
    switch (random() % 5) {
      case 0:
      case 1:
        spare.push_back(block, window_of(step));
        expected.push_back(window_of(step));
        break;
      case 2: {
        const std::size_t more = 1 + random() % 3;
        spare.insert(block, at, more);
        for (std::size_t i = 0; i < more; ++i) block.set(at + i, window_of(step + int(i)));
        for (std::size_t i = more; i-- > 0;)
          expected.insert(expected.begin() + std::ptrdiff_t(at), window_of(step + int(i)));
        break;
      }
      case 3: {
        const std::size_t fewer = std::min(n - at, std::size_t(random() % 4));
        block.shift(at, -std::ptrdiff_t(fewer));
        expected.erase(expected.begin() + std::ptrdiff_t(at),
                       expected.begin() + std::ptrdiff_t(at + fewer));
        break;
      }
      default: {  // the last ones first, in memory that another block had
        WindowBlock turned = spare.take(n);
        EXPECT_GE(turned.room(), n);
        turned.append(block, at, n);
        turned.append(block, 0, at);
        std::rotate(expected.begin(), expected.begin() + std::ptrdiff_t(at), expected.end());
        spare.give(std::exchange(block, std::move(turned)));
      }
    }
    ASSERT_EQ(block.size(), expected.size());
    if (step % 50 == 0)
      for (std::size_t i = 0; i < expected.size(); ++i) expect_same(block[i], expected[i]);
  }
  ASSERT_GT(expected.size(), 20U);
}

TEST(SpareBlocks, HaveRoomForWhatIsAskedAndNotMuchMore) {
  WindowMemory memory;
  SpareBlocks spare(memory);
  for (std::size_t n = 1; n < 3000; ++n) {
    WindowBlock block = spare.take(n);
    EXPECT_GE(block.room(), n);
    EXPECT_LE(block.room(), n + n / 4 + 4);
    const std::size_t room = block.room();
    EXPECT_EQ(WindowMemory::room_of(WindowMemory::size_for(n)), room);
    const double* const piece = block.memory();
    spare.give(std::move(block));
    EXPECT_EQ(spare.take(room).memory(), piece);
  }
}

/// Columns of blocks of all sizes, each full of a number of its own.
class FullBlocks {
 public:
  explicit FullBlocks(WindowMemory& memory) : spare_(memory) {}
  void add(std::size_t n) {
    WindowBlock block = spare_.take(n);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block.memory()) % 64, 0U);
    block.resize(block.room());
    const std::size_t columns = WindowBlock::n_numbers + 1;
    numbers_.push_back(next_++);
    std::fill_n(block.memory(), columns * (block.room() + WindowBlock::spare), numbers_.back());
    blocks_.push_back(std::move(block));
  }
  void check_and_give(std::size_t i) {
    const std::size_t columns = WindowBlock::n_numbers + 1;
    const double* const numbers = blocks_[i].memory();
    EXPECT_EQ(std::count(numbers, numbers + columns * (blocks_[i].room() + WindowBlock::spare),
                         numbers_[i]),
              std::ptrdiff_t(columns * (blocks_[i].room() + WindowBlock::spare)));
    std::swap(blocks_[i], blocks_.back());
    std::swap(numbers_[i], numbers_.back());
    spare_.give(std::move(blocks_.back()));
    blocks_.pop_back();
    numbers_.pop_back();
  }
  std::size_t size() const { return blocks_.size(); }

 private:
  SpareBlocks spare_;
  std::vector<WindowBlock> blocks_;
  std::vector<double> numbers_;
  double next_ = 0;
};

TEST(WindowMemory, PiecesAreApartAndUsedAgainWhateverTheirSize) {
  WindowMemory memory;
  FullBlocks blocks(memory);
  std::mt19937 random(5);
  double pages = 0;
  for (const std::size_t most : {8, 400, 40, 2000, 3, 300, 8}) {
    for (int i = 0; i < 3000; ++i) {
      blocks.add(1 + random() % most);
      if (i % 3 == 2) blocks.check_and_give(random() % blocks.size());
    }
    while (blocks.size() > 0) blocks.check_and_give(random() % blocks.size());
    if (most == 2000) pages = memory.bytes();
  }
  EXPECT_EQ(memory.bytes(), pages);
}

TEST(WindowMemory, ThreadsGiveWhatOthersTook) {
  WindowMemory memory;
  std::vector<std::vector<WindowBlock>> taken(2);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::thread> threads;
    for (int t = 0; t < 2; ++t)
      threads.emplace_back([&, t] {
        SpareBlocks spare(memory);
        for (WindowBlock& block : taken[std::size_t(t)]) {
          for (std::size_t i = 0; i < block.size(); ++i)
            EXPECT_EQ(block[i].b0, window_of(int(block.size() + i)).b0);
          spare.give(std::move(block));
        }
        taken[std::size_t(t)].clear();
        for (int n = 1; n < 300; ++n) {
          WindowBlock block;
          for (int i = 0; i < n; ++i) spare.push_back(block, window_of(n + i));
          taken[std::size_t(t)].push_back(std::move(block));
        }
      });
    for (std::thread& thread : threads) thread.join();
    std::swap(taken[0], taken[1]);
  }
}

}  // namespace
}  // namespace littoral
