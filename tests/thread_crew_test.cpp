// Threads that stay do every piece once, as the caller would.

#include "base/thread_crew.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "base/platform/floating_point.h"

namespace littoral {
namespace {

TEST(ThreadCrew, DoesEveryPieceOnceInAnyNumberOfLoops) {
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    ThreadCrew crew;
    EXPECT_EQ(crew.size(), threads);
    for (std::size_t n = 0; n < 300; ++n) {
      std::vector<int> done(n, 0);
      crew.run(n, [&](std::size_t i) { done[i] += int(i) + 1; });
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(done[i], int(i) + 1) << n;
    }
  }
  set_thread_count(0);
}

/// Each of the two waits for the other: one thread alone would never end.
TEST(ThreadCrew, PiecesRunAtTheSameTime) {
  set_thread_count(2);
  ThreadCrew crew;
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> there{0};
    crew.run(2, [&](std::size_t) {
      ++there;
      while (there < 2) std::this_thread::yield();
    });
    EXPECT_EQ(there, 2);
  }
  set_thread_count(0);
}

TEST(ThreadCrew, ThrowsWhatTheFirstPieceThrewAndGoesOn) {
  set_thread_count(3);
  ThreadCrew crew;
  for (int round = 0; round < 20; ++round) {
    try {
      crew.run(40, [](std::size_t i) {
        if (i == 0) throw std::runtime_error("first");
        if (i > 35) throw std::runtime_error("late");
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "first");
    }
    std::atomic<int> sum{0};
    crew.run(10, [&](std::size_t i) { sum += int(i); });
    EXPECT_EQ(sum, 45);
  }
  set_thread_count(0);
}

/// Each thread begins with a share of its own, and may throw before the first piece that does.
TEST(ThreadCrew, ThrowsWhatTheFirstOfManyThrew) {
  set_thread_count(4);
  ThreadCrew crew;
  for (int round = 0; round < 100; ++round) {
    try {
      crew.run(40, [](std::size_t i) {
        if (i >= 5) throw std::runtime_error(std::to_string(i));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "5");
    }
  }
  set_thread_count(0);
}

TEST(ThreadCrew, LoopsInsideLoopsRunOnTheThreadThatMeetsThem) {
  set_thread_count(3);
  ThreadCrew crew;
  std::vector<int> inner_size(6, 0), same(6, 0);
  crew.run(6, [&](std::size_t i) {
    ThreadCrew inner;
    inner_size[i] = inner.size();
    const auto here = std::this_thread::get_id();
    same[i] = 1;
    inner.run(8, [&](std::size_t) { same[i] &= std::this_thread::get_id() == here; });
    parallel_for(8, 1,
                 [&](std::size_t, std::size_t) { same[i] &= std::this_thread::get_id() == here; });
  });
  EXPECT_EQ(inner_size, std::vector<int>(6, 1));
  EXPECT_EQ(same, std::vector<int>(6, 1));
  set_thread_count(0);
}

TEST(ThreadCrew, ThreadsThatStayTakeOverTheCallersModeAnew) {
  set_thread_count(2);
  ThreadCrew crew;
  const auto same_modes = [&] {
    const std::uint64_t mode = floating_point_mode();
    std::atomic<int> there{0}, same{0};
    crew.run(2, [&](std::size_t) {
      ++there;
      while (there < 2) std::this_thread::yield();
      same += floating_point_mode() == mode;
    });
    return same.load();
  };
  EXPECT_EQ(same_modes(), 2);
  {
    const FlushSubnormals flush;
    EXPECT_EQ(same_modes(), 2);
  }
  EXPECT_EQ(same_modes(), 2);
  set_thread_count(0);
}

TEST(KeepThreads, LoopsAreSharedWithTheSameThreads) {
  set_thread_count(2);
  const auto others = [] {  // each of the two waits for the other
    std::atomic<int> there{0};
    std::array<std::thread::id, 2> by;
    parallel_for(2, 1, [&](std::size_t i, std::size_t) {
      by[i] = std::this_thread::get_id();
      ++there;
      while (there < 2) std::this_thread::yield();
    });
    return by[by[0] == std::this_thread::get_id()];
  };
  {
    const KeepThreads keep;
    const std::thread::id other = others();
    for (int round = 0; round < 50; ++round) ASSERT_EQ(others(), other);
    {
      const KeepThreads inner;
      EXPECT_NE(others(), other);
    }
    EXPECT_EQ(others(), other);
    set_thread_count(1);
    parallel_for(8, 1,
                 [&](std::size_t, std::size_t) { EXPECT_NE(std::this_thread::get_id(), other); });
    set_thread_count(2);
    EXPECT_THROW(parallel_for(8, 1,
                              [](std::size_t i, std::size_t) {
                                if (i == 5) throw std::runtime_error("fifth");
                              }),
                 std::runtime_error);
    EXPECT_EQ(others(), other);
  }
  EXPECT_NE(others(), std::this_thread::get_id());
  set_thread_count(0);
}

}  // namespace
}  // namespace littoral
