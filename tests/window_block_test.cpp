// Windows column by column are what they were one by one.

#include "methods/geodesic/window_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

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
  SpareBlocks spare;
  WindowBlock block;
  for (int step = 0; step < 2000; ++step) {
    const std::size_t n = expected.size(), at = n == 0 ? 0 : random() % n;
    switch (random() % 5) {
      case 0:
      case 1:
        block.push_back(window_of(step));
        expected.push_back(window_of(step));
        break;
      case 2: {
        const std::size_t more = 1 + random() % 3;
        block.shift(at, std::ptrdiff_t(more));
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

TEST(SpareBlocks, HaveRoomForWhatIsAskedAndHalfAsMuchMoreAtMost) {
  SpareBlocks spare;
  for (std::size_t n = 1; n < 3000; ++n) {
    WindowBlock block = spare.take(n);
    EXPECT_GE(block.room(), n);
    EXPECT_LE(block.room(), std::max<std::size_t>(4, n + n / 2));
    const std::size_t room = block.room();
    spare.give(std::move(block));
    EXPECT_EQ(spare.take(room).room(), room);  // the same one
  }
}

TEST(SpareBlocks, KeepNoMoreThanTheyMay) {
  SpareBlocks spare;
  spare.most_room = 10;
  WindowBlock first, second;
  first.reserve(8);
  second.reserve(12);
  const double* const memory = first.column(WindowBlock::b0);
  spare.give(std::move(second));  // too large
  spare.give(std::move(first));
  EXPECT_EQ(spare.take(8).column(WindowBlock::b0), memory);
}

}  // namespace
}  // namespace littoral
