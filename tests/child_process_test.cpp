// Programs run beside this one: every way to end.

#include "base/platform/child_process.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/platform/temporary_folder.h"
#include "littoral/error.h"

namespace littoral {
namespace {

class ChildProcess : public ::testing::Test {
 protected:
  ChildEnd shell(const std::string& script, double timeout = 20, const Task& task = Task()) {
    return run_child("/bin/sh", {"-c", script}, folder_, timeout, task);
  }

  const TemporaryFolder made_{"child"};
  const std::filesystem::path folder_ = made_.path();
};

TEST_F(ChildProcess, TellsStatusSignalAndLastLine) {
  EXPECT_EQ(shell("exit 0").status, 0);
  const ChildEnd seven = shell("echo first; echo; printf 'l\\033ast\\n \\n' >&2; exit 7");
  EXPECT_EQ(seven.status, 7);
  EXPECT_EQ(seven.signal, 0);
  EXPECT_EQ(seven.said, "last");
  const ChildEnd killed = shell("kill -SEGV $$");
  EXPECT_EQ(killed.signal, SIGSEGV);
  EXPECT_FALSE(killed.timed_out);
}

TEST_F(ChildProcess, RunsInTheFolderWithEmptyInput) {
  EXPECT_EQ(shell("cat > copy; pwd > where").status, 0);
  EXPECT_EQ(std::filesystem::file_size(folder_ / "copy"), 0u);
  std::string where;
  std::ifstream(folder_ / "where") >> where;
  EXPECT_TRUE(std::filesystem::equivalent(where, folder_));
}

TEST_F(ChildProcess, IsEndedWhenItsTimeIsUp) {
  EXPECT_TRUE(shell("sleep 100", 0.1).timed_out);
  EXPECT_TRUE(shell("trap '' TERM INT; sleep 100 & wait", 0.1).timed_out);
}

TEST_F(ChildProcess, IsEndedOnRequest) {
  const CancelToken cancel;
  std::thread later([&cancel] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    cancel.cancel();
  });
  EXPECT_THROW(shell("sleep 100", 50, Task(cancel)), Cancelled);
  later.join();
}

TEST_F(ChildProcess, FindsProgramsInThePathAndNothingElse) {
  EXPECT_TRUE(find_program("sh"));
  EXPECT_TRUE(find_program("/bin/sh"));
  EXPECT_FALSE(find_program("no-such-program-anywhere"));
  EXPECT_FALSE(find_program("/etc/passwd"));
  EXPECT_FALSE(find_program(folder_.string()));
}

TEST_F(ChildProcess, ThatCannotBeStartedSaysSo) {
  EXPECT_EQ(run_child(folder_ / "missing", {}, folder_, 20, Task()).status, 127);
}

}  // namespace
}  // namespace littoral
