#include "base/platform/interrupts.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <memory>
#include <thread>

namespace littoral {
namespace {

std::atomic<int> passed_on{0};

// Under a sanitizer: the token of a call that has ended is not touched by a handler on another
// thread.
TEST(InterruptsOfThreads, ReachTheTokenOfTheCallOrNobody) {
  const auto before = std::signal(SIGINT, [](int) { ++passed_on; });
  std::atomic<bool> done{false};
  int raised = 0;
  std::thread other([&] {
    while (!done) {
      std::raise(SIGINT);
      ++raised;
    }
  });
  int stopped = 0;
  for (int i = 0; i < 3000 || (stopped == 0 && i < 1000000); ++i) {
    const auto token = std::make_unique<CancelToken>();
    {
      const CancelOnInterrupt watch(*token);
      if (i % 100 == 0) std::this_thread::yield();
    }
    if (token->cancelled()) ++stopped;
  }
  done = true;
  other.join();
  std::signal(SIGINT, before);
  EXPECT_GT(stopped, 0);
  EXPECT_EQ(passed_on, raised);  // every signal went where it went before, too
}

}  // namespace
}  // namespace littoral
