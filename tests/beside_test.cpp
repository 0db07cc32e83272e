// Work beside the caller's: done once, on a thread of its own.

#include "base/beside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/now_and_then.h"
#include "base/parallel.h"
#include "base/platform/floating_point.h"
#include "littoral/error.h"

namespace littoral {
namespace {

/// The caller and the work wait for each other: one thread alone would never end.
TEST(Beside, RunsWhileTheCallerGoesOn) {
  set_thread_count(2);
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> there{0};
    Beside work([&](const Task&) {
      ++there;
      while (there < 2) std::this_thread::yield();
    });
    while (there < 1) std::this_thread::yield();
    ++there;
    work.finish({});
    EXPECT_EQ(there, 2);
  }
  set_thread_count(0);
}

TEST(Beside, IsDoneOnceAsTheCallerWould) {
  set_thread_count(2);
  const FlushSubnormals flush;
  int done = 0;
  std::uint64_t mode = 0;
  Beside work([&](const Task&) {
    ++done;
    mode = floating_point_mode();
  });
  work.finish({});
  EXPECT_EQ(done, 1);
  EXPECT_EQ(mode, floating_point_mode());
  set_thread_count(0);
}

TEST(Beside, LeavesItToTheCallerWhereThereIsOneThreadOnly) {
  const auto done_here = [] {
    std::thread::id by;
    {
      const Beside forgotten([&](const Task&) { by = std::this_thread::get_id(); });
    }
    EXPECT_EQ(by, std::thread::id());
    Beside work([&](const Task&) { by = std::this_thread::get_id(); });
    EXPECT_EQ(by, std::thread::id());
    work.finish({});
    return by == std::this_thread::get_id();
  };
  set_thread_count(1);
  EXPECT_TRUE(done_here());
  set_thread_count(2);
  std::atomic<int> here{0};
  parallel_for(4, 1, [&](std::size_t, std::size_t) { here += done_here(); });
  EXPECT_EQ(here, 4);
  set_thread_count(0);
}

TEST(Beside, ThrowsWhatTheWorkThrew) {
  set_thread_count(2);
  Beside work([](const Task&) { throw std::runtime_error("beside"); });
  try {
    work.finish({});
    ADD_FAILURE() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "beside");
  }
  const Beside forgotten([](const Task&) { throw std::runtime_error("beside"); });
  set_thread_count(0);
}

/// Both threads are in a loop; then one waits for the other; then the loop is over.
TEST(Beside, GivesWayToLoopsThatKeepAllThreadsBusy) {
  using std::chrono::milliseconds;
  set_thread_count(2);
  std::atomic<int> steps{0}, inside{0}, while_busy{-1};
  std::atomic<bool> enough{false};
  const auto goes_on = [&] {
    const int before = steps;
    while (steps < before + 3) std::this_thread::yield();
  };
  Beside work([&](const Task& task) {
    for (; !enough; ++steps) task.checkpoint();
  });
  goes_on();
  parallel_for(2, 1, [&](std::size_t piece, std::size_t) {
    ++inside;
    while (inside < 2) std::this_thread::yield();
    if (piece == 0) {
      const int before = steps;
      std::this_thread::sleep_for(milliseconds(20));
      while_busy = steps - before;
      ++inside;
    } else {
      while (inside < 3) std::this_thread::yield();
      const WaitsForOthers waits;
      goes_on();
    }
  });
  EXPECT_LE(while_busy, 1);  // that it had begun
  goes_on();
  enough = true;
  work.finish({});
  set_thread_count(0);
}

/// Whoever waits for it is one of those who keep the others waiting.
TEST(Beside, GivesWayToNobodyOnceItIsWaitedFor) {
  set_thread_count(2);
  std::atomic<bool> over{false};
  std::atomic<int> inside{0};
  std::thread busy([&] {
    set_thread_count(2);
    parallel_for(2, 1, [&](std::size_t, std::size_t) {
      ++inside;
      while (!over) std::this_thread::yield();
    });
  });
  while (inside < 2) std::this_thread::yield();
  Beside work([](const Task& task) {
    for (int i = 0; i < 100; ++i) task.checkpoint();
  });
  work.finish({});
  over = true;
  busy.join();
  set_thread_count(0);
}

/// Pieces of its loop wait for each other: the work's own thread alone would never end.
TEST(Beside, WhoWaitsTakesPartInItsLoops) {
  set_thread_count(2);
  const std::uint64_t mode = floating_point_mode();
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> there{0}, of_nested{0};
    std::vector<int> done(100, 0);
    std::uint64_t of_piece[2] = {0, 0};
    std::unique_ptr<Beside> work;
    {
      const FlushSubnormals flush;
      work = std::make_unique<Beside>([&](const Task&) {
        parallel_for(2, 1, [&](std::size_t piece, std::size_t) {
          of_piece[piece] = floating_point_mode();
          ++there;
          while (there < 2) std::this_thread::yield();
          const auto by = std::this_thread::get_id();
          parallel_for(4, 1, [&](std::size_t, std::size_t) {
            of_nested += by == std::this_thread::get_id();
          });
        });
        parallel_for(done.size(), 1, [&](std::size_t i, std::size_t) { ++done[i]; });
      });
    }
    work->finish({});
    EXPECT_EQ(there, 2);
    EXPECT_EQ(of_nested, 8);
    EXPECT_EQ(std::count(done.begin(), done.end(), 1), 100);
    EXPECT_EQ(of_piece[0], of_piece[1]);
    EXPECT_EQ(floating_point_mode(), mode);
  }
  set_thread_count(0);
}

TEST(Beside, LoopsEndWhereNobodyWaitsForThem) {
  set_thread_count(2);
  std::vector<int> done(1000, 0);
  std::atomic<bool> over{false};
  Beside work([&](const Task&) {
    parallel_for(done.size(), 1, [&](std::size_t i, std::size_t) { ++done[i]; });
    over = true;
  });
  while (!over) std::this_thread::yield();
  work.finish({});
  EXPECT_EQ(std::count(done.begin(), done.end(), 1), 1000);
  set_thread_count(0);
}

TEST(Beside, ThrowsWhatALowestPieceThrew) {
  set_thread_count(2);
  for (int round = 0; round < 20; ++round) {
    Beside work([](const Task&) {
      std::atomic<int> there{0};
      parallel_for(2, 1, [&](std::size_t piece, std::size_t) {
        ++there;
        while (there < 2) std::this_thread::yield();
        throw std::runtime_error(std::to_string(piece));
      });
    });
    try {
      work.finish({});
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "0");
    }
  }
  set_thread_count(0);
}

/// Pieces go on until the one that waits has given up; it leaves after the piece it is in.
TEST(Beside, TakingPartCanBeCancelled) {
  set_thread_count(2);
  const CancelToken cancel;
  std::atomic<int> there{0};
  Beside work([&](const Task& until_nobody_waits) {
    parallel_for(1000, 1, [&](std::size_t, std::size_t) {
      if (++there == 2) cancel.cancel();
      while (there < 2) std::this_thread::yield();
      stop_if_cancelled(until_nobody_waits);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  });
  EXPECT_THROW(work.finish(Task(cancel)), Cancelled);
  set_thread_count(0);
}

/// The work ends only when the one that waits for it has given up.
TEST(Beside, WaitingCanBeCancelled) {
  set_thread_count(2);
  const CancelToken cancel;
  Beside work([&](const Task& until_nobody_waits) {
    cancel.cancel();
    while (!until_nobody_waits.cancelled()) std::this_thread::yield();
  });
  EXPECT_THROW(work.finish(Task(cancel)), Cancelled);
  set_thread_count(0);
}

TEST(Beside, EndsBeforeItIsGone) {
  set_thread_count(2);
  for (int round = 0; round < 20; ++round) {
    std::atomic<bool> inside{false};
    {
      const Beside work([&](const Task&) {
        inside = true;
        std::this_thread::yield();
        inside = false;
      });
    }
    EXPECT_FALSE(inside);
  }
  set_thread_count(0);
}

TEST(Task, SilentOnesReportNothingAndAreCancelledWithTheOther) {
  const CancelToken cancel;
  int reports = 0;
  const Task task(cancel, [&](double, const std::string&) { ++reports; });
  const Task silent = task.silent();
  silent.checkpoint(0.5);
  EXPECT_EQ(reports, 0);
  task.checkpoint(0.5);
  EXPECT_EQ(reports, 1);
  EXPECT_FALSE(silent.cancelled());
  cancel.cancel();
  EXPECT_TRUE(silent.cancelled());
  EXPECT_THROW(silent.checkpoint(), Cancelled);
  EXPECT_NO_THROW(Task().silent().checkpoint());
}

}  // namespace
}  // namespace littoral
