// When iterations are given up, for residuals that are known.

#include "methods/regularized/pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace littoral {
namespace {

/// After how many iterations those with this residual are given up; 0: it is 1 before.
int given_up(const std::function<double(int)>& residual) {
  Pace pace;
  for (int k = 5; residual(k) > 1; k += 5)
    if (!pace.hopeful(k, residual(k))) return k;
  return 0;
}

/// A residual that falls by the same factor each time and is 1 after so many iterations.
std::function<double(int)> done_after(int iterations) {
  return [iterations](int k) { return std::exp(1e-4 * (iterations - k)); };
}

TEST(Pace, TenTimesAsManyIterationsAreWaitedFor) {
  for (const int iterations : {9000, 20000, 100000, 109000}) {
    EXPECT_EQ(given_up(done_after(iterations)), 0) << iterations;
  }
  for (const int iterations : {111000, 150000, 1000000}) {
    EXPECT_EQ(given_up(done_after(iterations)), 10000) << iterations;
  }
}

TEST(Pace, ResidualsThatStayAreGivenUpAtTheSecondMark) {
  for (const double size : {1.0001, 2.0, 1e9})
    EXPECT_EQ(given_up([&](int) { return size; }), 10000) << size;
  EXPECT_EQ(given_up([](int k) { return 1.0 + k; }), 10000);
  EXPECT_EQ(given_up([](int k) { return k < 10000 ? 1e9 : 3.0; }), 15000);
}

TEST(Pace, ThoseThatStayLaterOnAreGivenUpAMarkLater) {
  // Marks: 6667, 10000, 15000, 22500, 33750, 50625.
  const auto until = [](int stays) {
    return [stays](int k) { return std::exp(1e-3 * (60000 - std::min(k, stays))); };
  };
  EXPECT_EQ(given_up(until(15000)), 22500);
  EXPECT_EQ(given_up(until(22500)), 33750);
  EXPECT_EQ(given_up(until(33750)), 50625);
}

TEST(Pace, TheLeastSoFarCounts) {
  // Up and down, lower each time: as if it fell steadily. Up and down about one value: it stays.
  const auto wave = [](int k) { return k % 2000 < 1000 ? 1.0 : 20.0; };
  EXPECT_EQ(given_up([&](int k) { return wave(k) * done_after(80000)(k) + 1e-9; }), 0);
  EXPECT_EQ(given_up([&](int k) { return 5 * wave(k); }), 10000);
}

}  // namespace
}  // namespace littoral
