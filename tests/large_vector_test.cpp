#include "base/large_vector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace littoral {
namespace {

bool begins_a_page(const void* at) {
  return reinterpret_cast<std::uintptr_t>(at) % large_page == 0;
}

TEST(LargeVector, BeginsWhereALargePageDoesIfItIsLarge) {
  LargeVector<int> numbers(5'000'000);
  EXPECT_TRUE(begins_a_page(numbers.data()));
  std::iota(numbers.begin(), numbers.end(), 0);
  const LargeVector<int> copy = numbers;
  EXPECT_TRUE(begins_a_page(copy.data()));
  numbers.push_back(7);
  EXPECT_TRUE(begins_a_page(numbers.data()));
  EXPECT_TRUE(std::equal(copy.begin(), copy.end(), numbers.begin()));
  const int* const at = numbers.data();
  const LargeVector<int> moved = std::move(numbers);
  EXPECT_EQ(moved.data(), at);
  EXPECT_EQ(moved.back(), 7);
}

TEST(LargeVector, KeepsTheAlignmentOfWhatItHolds) {
  struct alignas(64) Line {
    char bytes[64];
  };
  for (const std::size_t n : {std::size_t(1), std::size_t(3), 4 * large_page / sizeof(Line)}) {
    LargeVector<Line> lines(n);
    for (Line& line : lines) line.bytes[0] = 1;
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lines.data()) % 64, 0);
  }
}

}  // namespace
}  // namespace littoral
