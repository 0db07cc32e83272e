// Whole files: by any number of threads, of any size, packed or not, and what is no plain file.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "base/parallel.h"
#include "base/platform/temporary_folder.h"
#include "io/read.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

std::string numbered_bytes(std::size_t n) {
  std::string bytes(n, '\0');
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<char>((i * 2654435761u) >> 13);
  return bytes;
}

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(FileBytes, AreThoseOfTheFileByAnyNumberOfThreads) {
  const TemporaryFolder folder("littoral-test");
  const std::filesystem::path path = folder.path() / "bytes";
  constexpr std::size_t piece = 1 << 20;
  for (const std::size_t n :
       {std::size_t(0), std::size_t(1), piece - 1, piece, piece + 1, 3 * piece, 9 * piece + 17}) {
    const std::string expected = numbered_bytes(n);
    write(path, expected);
    for (const int threads : {1, 2, 3}) {
      set_thread_count(threads);
      EXPECT_TRUE(FileBytes(path).view() == expected) << n;
      EXPECT_TRUE(read_bytes(path) == expected) << n;
    }
  }
  set_thread_count(0);
}

TEST(FileBytes, OfAPipeAreAllThatComes) {
  const TemporaryFolder folder("littoral-test");
  const std::filesystem::path path = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  for (const std::size_t n : {10, 300'000}) {
    const std::string expected = numbered_bytes(n);
    std::thread writer([&] { write(path, expected); });
    EXPECT_TRUE(FileBytes(path).view() == expected);
    writer.join();
  }
}

/// Files of the system say to be empty, or a page long, whatever is in them.
TEST(FileBytes, OfFilesThatAreLongerOrShorterThanTheySay) {
  const std::filesystem::path longer = "/proc/self/limits", shorter = "/sys/kernel/mm/ksm/run";
  int known = 0;
  for (const auto& path : {longer, shorter}) {
    std::ifstream file(path);
    const std::string expected{std::istreambuf_iterator<char>(file), {}};
    if (expected.empty()) continue;
    ++known;
    EXPECT_NE(std::filesystem::file_size(path), expected.size());
    EXPECT_EQ(FileBytes(path).view(), expected);
  }
  if (known == 0) GTEST_SKIP() << "the system has no such files";
}

TEST(FileBytes, WithoutAFileAreAnErrorThatNamesIt) {
  for (const char* path : {"/nowhere/a.ply", "/"}) {
    try {
      const FileBytes bytes(path);
      ADD_FAILURE() << path;
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace littoral::io
