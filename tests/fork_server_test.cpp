// Work in forked processes: every way to end, and what stays of it.

#include "base/platform/fork_server.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <vector>

#include "base/platform/temporary_folder.h"
#include "base/sha256.h"
#include "littoral/batch.h"
#include "littoral/error.h"
#include "shared_data.h"

namespace littoral {
namespace {

/// What the tests ask a child to do.
void forked_work(const std::string& request, const ForkServer::Tell& tell) {
  if (request == "pid") return tell(std::to_string(::getpid()));
  if (request == "throw") throw InputError("lost");
  if (request == "segv") {
    std::signal(SIGSEGV, SIG_DFL);  // sanitizers have a handler that ends in another way
    ::raise(SIGSEGV);
  }
  if (request == "exit") ::_exit(3);
  if (request == "sleep") ::sleep(100);
  if (request == "print") {
    std::cout << "out, ";
    std::cerr << "err";
  }
  if (request == "fill") {
    std::vector<char> many(std::size_t{1} << 31, 'x');
    tell(std::string(1, many[many.size() / 2]));
  }
  tell("first ");
  tell(request);
}

ForkEnd forked_end(const std::string& request, const ForkLimits& limits = {}) {
  const ForkServer server(forked_work);
  server.start(7, request, limits);
  return server.wait(20).value();
}

TEST(ForkServer, TellsHowWorkEnded) {
  const ForkEnd plain = forked_end("plain");
  EXPECT_EQ(plain.id, 7u);
  EXPECT_EQ(plain.told, "first plain");
  EXPECT_EQ(plain.signal, 0);
  EXPECT_GT(plain.peak_memory, 1e5);
  EXPECT_GE(plain.seconds, plain.start_seconds);
  EXPECT_GT(plain.start_seconds, 0);
  EXPECT_EQ(forked_end("print").printed, "out, err");
  EXPECT_EQ(forked_end("segv").signal, SIGSEGV);
  for (const char* request : {"throw", "exit"}) {
    const ForkEnd end = forked_end(request);
    EXPECT_EQ(end.told, "");
    EXPECT_EQ(end.signal, 0);
  }
}

TEST(ForkServer, EndsWhatTakesTooLong) {
  const ForkEnd end = forked_end("sleep", {0.05, 0});
  EXPECT_TRUE(end.timed_out);
  EXPECT_LT(end.seconds, 20);
}

TEST(ForkServer, WorkDoesNotOutliveIt) {
  ForkServer server(forked_work);
  server.start(1, "pid", {});
  const pid_t server_of = ::getpid();
  EXPECT_NE(server.wait(20).value().told, std::to_string(server_of));
  server.start(2, "sleep", {});
  EXPECT_FALSE(server.wait(0.05).has_value());
}  // its end would wait for the sleep

TEST(ForkServer, LimitsMemory) {
  if (test::sanitized()) GTEST_SKIP() << "the sanitizer's shadow of memory exceeds the limit";
  const ForkEnd end = forked_end("fill", {0, 1e9});
  EXPECT_EQ(end.told, "") << "the allocation throws";
  EXPECT_LT(end.peak_memory, 1e9);
}

TEST(ForkServer, DoesManyAtOnce) {
  const ForkServer server(forked_work);
  constexpr std::uint64_t n = 100;
  const std::string large(300000, 'x');
  for (std::uint64_t id = 0; id < n; ++id) server.start(id, id == 50 ? large : "", {});
  std::vector<int> seen(n);
  for (std::uint64_t k = 0; k < n; ++k) {
    const ForkEnd end = server.wait(20).value();
    ++seen[end.id];
    EXPECT_EQ(end.told.size(), end.id == 50 ? 300006u : 6u);
  }
  EXPECT_EQ(seen, std::vector<int>(n, 1));
}

/// Requests and answers that together exceed what the system keeps between two processes.
TEST(ForkServer, IsAskedWhileItAnswers) {
  const ForkServer server(forked_work);
  constexpr std::uint64_t n = 20;
  const std::string large(3000000, 'x');
  ::alarm(60);  // two that wait for each other would do so for ever
  for (std::uint64_t id = 0; id < n; ++id) server.start(id, large, {});
  for (std::uint64_t k = 0; k < n; ++k) EXPECT_EQ(server.wait(20).value().told, "first " + large);
  ::alarm(0);
}

TEST(Sha256, HasTheKnownDigests) {
  const auto of = [](const std::string& text) {
    Sha256 sum;
    sum.add(text);
    return sum.digest();
  };
  // FIPS 180-4's examples, and a million of one letter.
  EXPECT_EQ(of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  Sha256 pieces;
  for (int k = 0; k < 10000; ++k) pieces.add(std::string(100, 'a'));
  EXPECT_EQ(pieces.digest(), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

/// A batch of two jobs, whose work is given by their names.
BatchSummary small_batch(const std::filesystem::path& folder, bool fail) {
  Batch batch({[fail](const BatchJob& job, const std::filesystem::path& where) -> BatchOutcome {
                 if (fail && job.input == "b") throw SolveError("diverged");
                 std::filesystem::create_directory(where / (job.input + ".dir"));
                 return {"done", "", "{\"name\": \"" + job.input + "\"}"};
               },
               [](const BatchJob& job, const std::filesystem::path&) { return job.input; }});
  return batch.run({{"a", "x/a", {}}, {"b", "x/b", {}}}, {.folder = folder});
}

TEST(Batch, RunsFunctionsAndGoesOn) {
  const TemporaryFolder made("batch");
  const auto folder = made.path() / "out";
  const BatchSummary first = small_batch(folder, true);
  EXPECT_EQ(first.done, 1u);
  EXPECT_EQ(first.failed, 1u);
  ASSERT_EQ(first.failures.size(), 1u);
  EXPECT_EQ(first.failures[0].status, "solve");
  EXPECT_EQ(first.failures[0].message, "diverged");
  EXPECT_EQ(first.failures[0].example, "b");
  const BatchSummary second = small_batch(folder, false);
  EXPECT_EQ(second.done, 1u);
  EXPECT_EQ(second.unchanged, 1u);
  EXPECT_TRUE(std::filesystem::is_directory(folder / "x/b.dir"));
  EXPECT_FALSE(std::filesystem::exists(folder / ".status.tmp"));
}

/// Twenty jobs, four at once, under a server that may hold so many more files open than it starts
/// with: two for each process.
BatchSummary batch_with_few_files(const std::filesystem::path& folder, rlim_t more) {
  const int lowest = ::dup(STDERR_FILENO);
  ::close(lowest);
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  rlimit few = before;
  few.rlim_cur = static_cast<rlim_t>(lowest) + 3 + more;
  ::setrlimit(RLIMIT_NOFILE, &few);
  Batch batch({[](const BatchJob&, const std::filesystem::path& where) -> BatchOutcome {
                 std::filesystem::create_directory(where / "made");
                 return {};
               },
               [](const BatchJob& job, const std::filesystem::path&) { return job.input; }});
  ::setrlimit(RLIMIT_NOFILE, &before);
  std::vector<BatchJob> jobs;
  for (char name = 'a'; name < 'u'; ++name)
    jobs.push_back({{name}, std::string{name, '/', name}, {}});
  return batch.run(jobs, {.folder = folder, .processes = 4, .start_patience = 0.2});
}

TEST(Batch, WaitsWhereTheSystemHasNoPlaceForAnotherProcess) {
  const TemporaryFolder made("batch");
  const BatchSummary summary = batch_with_few_files(made.path() / "out", 2);
  EXPECT_EQ(summary.done, 20u);
  EXPECT_EQ(summary.failed, 0u);
  try {
    batch_with_few_files(made.path() / "none", 0);
    FAIL() << "nothing can be started";
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("cannot start a process: Too many open files; run again"),
              std::string::npos)
        << e.what();
  }
  EXPECT_EQ(std::filesystem::file_size(made.path() / "none/status.jsonl"), 0u);
  EXPECT_FALSE(std::filesystem::exists(made.path() / "none/.status.tmp"));
}

TEST(Batch, KeepsTextsWithZeroBytes) {
  const TemporaryFolder made("batch");
  const std::string message("one\0two", 7);
  Batch batch({[&](const BatchJob&, const std::filesystem::path&) -> BatchOutcome {
                 return {"solve", message, "[1]"};
               },
               [](const BatchJob&, const std::filesystem::path&) { return std::string("h"); }});
  const BatchSummary summary = batch.run({{"a", "a", {}}}, {.folder = made.path()});
  ASSERT_EQ(summary.failures.size(), 1u);
  EXPECT_EQ(summary.failures[0].message, message);
  Batch other({[](const BatchJob&, const std::filesystem::path&) { return BatchOutcome{}; }});
  EXPECT_THROW(other.run({{message, "a", {}}}, {.folder = made.path()}), InputError);
}

TEST(Batch, DoesNotReplaceItsOwnFile) {
  const TemporaryFolder made("batch");
  Batch batch({[](const BatchJob&, const std::filesystem::path& where) -> BatchOutcome {
                 std::filesystem::create_directory(where / "status.jsonl");
                 return {};
               },
               [](const BatchJob& job, const std::filesystem::path&) { return job.input; }});
  const BatchSummary summary =
      batch.run({{"a", "status", {}}, {"b", "below/status", {}}}, {.folder = made.path()});
  EXPECT_EQ(summary.done, 1u) << "below it the name is free";
  ASSERT_EQ(summary.failures.size(), 1u);
  EXPECT_EQ(summary.failures[0].example, "a");
  EXPECT_TRUE(std::filesystem::is_regular_file(made.path() / "status.jsonl"));
}

TEST(Batch, RefusesNamesOutsideItsFolder) {
  const TemporaryFolder made("batch");
  for (const char* name : {"", "/a", "../a", "a/../../b", "a/"}) {
    Batch batch({[](const BatchJob&, const std::filesystem::path&) { return BatchOutcome{}; }});
    EXPECT_THROW(batch.run({{"a", name, {}}}, {.folder = made.path()}), InputError) << name;
  }
}

}  // namespace
}  // namespace littoral
