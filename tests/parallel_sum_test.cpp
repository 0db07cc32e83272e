// What pieces of a loop find, joined in order.

#include "base/parallel_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace littoral {
namespace {

double sum_of_roots(std::size_t n, std::size_t grain) {
  return of_pieces(n, grain, 0.0, [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += std::sqrt(double(i));
    return sum;
  });
}

TEST(ParallelSum, HasTheSameBitsOnAnyNumberOfThreads) {
  std::vector<double> found;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    found.push_back(sum_of_roots(100000, 1000));
  }
  set_thread_count(0);
  EXPECT_EQ(found[1], found[0]);
  EXPECT_EQ(found[2], found[0]);
  EXPECT_NEAR(found[0], 2. / 3 * std::pow(100000., 1.5) - 0.5 * std::sqrt(100000.), 1);
}

TEST(ParallelSum, JoinsInOrderWhatIsNotANumber) {
  for (const std::size_t n : {0, 1, 9, 10, 11, 95}) {
    std::string expected = "of:";
    for (std::size_t i = 0; i < n; ++i) expected += char('a' + i % 26);
    const std::string found = of_pieces(
        n, 10, std::string("of:"),
        [](std::size_t begin, std::size_t end) {
          std::string here;
          for (std::size_t i = begin; i < end; ++i) here += char('a' + i % 26);
          return here;
        },
        [](std::string all, const std::string& next) { return all + next; });
    EXPECT_EQ(found, expected);
  }
}

TEST(ParallelSum, LargestOfAll) {
  const auto largest = [](std::size_t begin, std::size_t end) {
    double here = 0;
    for (std::size_t i = begin; i < end; ++i) here = std::max(here, double(i * 7919 % 10007));
    return here;
  };
  EXPECT_EQ(of_pieces(10007, 100, 0.0, largest, Larger()), 10006);
}

}  // namespace
}  // namespace littoral
