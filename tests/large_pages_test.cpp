// Memory in large pages, and what is kept of it.

#include "base/platform/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <thread>

namespace littoral {
namespace {

constexpr std::size_t mebibyte = std::size_t(1) << 20;

std::uintptr_t address(const std::shared_ptr<void>& memory) {
  return reinterpret_cast<std::uintptr_t>(memory.get());
}

TEST(LargePages, AreZeroWhereThereAreAny) {
  EXPECT_EQ(large_pages(1000), nullptr);
  const std::size_t n = 5 * mebibyte + 8;
  for (int round = 0; round < 2; ++round) {  // used memory is not handed out again
    const auto memory = large_pages(n);
    if (!memory) GTEST_SKIP() << "this system has none";
    char* const bytes = static_cast<char*>(memory.get());
    EXPECT_EQ(address(memory) % large_page, 0U);
    EXPECT_EQ(std::count(bytes, bytes + n, 0), std::ptrdiff_t(n));
    std::fill(bytes, bytes + n, 1);
  }
}

TEST(LargePages, KeptOnesAreHandedOutInPiecesAndJoinedAgain) {
  const KeepLargePages keep;
  auto whole = large_pages(20 * mebibyte);
  if (!whole) GTEST_SKIP() << "this system has none";
  const std::uintptr_t at = address(whole);
  whole.reset();
  {
    auto first = large_pages(7 * mebibyte);
    const auto second = large_pages(9 * mebibyte);
    EXPECT_EQ(address(first), at);
    EXPECT_EQ(address(second), at + 8 * mebibyte);  // where a page begins
    first.reset();
    EXPECT_EQ(address(large_pages(8 * mebibyte)), at);
  }
  whole = large_pages(20 * mebibyte);
  EXPECT_EQ(address(whole), at);
  auto* const bytes = static_cast<char*>(whole.get());
  std::fill(bytes, bytes + 20 * mebibyte, 7);
  const auto other = large_pages(8 * mebibyte);  // what is left is too little
  auto* const others = static_cast<char*>(other.get());
  EXPECT_EQ(std::count(others, others + 8 * mebibyte, 0), std::ptrdiff_t(8 * mebibyte));
  std::fill(others, others + 8 * mebibyte, 1);
  EXPECT_EQ(std::count(bytes, bytes + 20 * mebibyte, 7), std::ptrdiff_t(20 * mebibyte));
}

TEST(LargePages, ThoseGivenBackByAnotherThreadAreHandedOut) {
  const KeepLargePages keep;
  auto memory = large_pages(10 * mebibyte);
  if (!memory) GTEST_SKIP() << "this system has none";
  const std::uintptr_t at = address(memory);
  std::thread([mine = std::move(memory)]() mutable { mine.reset(); }).join();
  EXPECT_EQ(address(large_pages(10 * mebibyte)), at);
  std::uintptr_t elsewhere = 0;
  std::thread([&] { elsewhere = address(large_pages(10 * mebibyte)); }).join();
  EXPECT_EQ(elsewhere, at);
}

}  // namespace
}  // namespace littoral
