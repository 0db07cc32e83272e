#pragma once
// Fixtures shipped with the tests, the larger collection beside the checkout where there is one,
// and what the tests are linked with.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace littoral::test {

std::filesystem::path source_dir();  // the checkout
bool sanitized();                    // the library is watched by a sanitizer

inline std::filesystem::path fixtures() { return source_dir() / "tests" / "fixtures"; }

/// LITTORAL_SHARED, or ../shared beside the checkout.
inline std::filesystem::path shared() {
  if (const char* path = std::getenv("LITTORAL_SHARED")) return path;
  return source_dir() / ".." / "shared";
}

}  // namespace littoral::test

/// Skips the running test, visibly, where the shared data collection is absent.
#define LITTORAL_NEEDS_SHARED(relative)                                \
  if (!std::filesystem::exists(littoral::test::shared() / (relative))) \
  GTEST_SKIP() << "needs " << (littoral::test::shared() / (relative))
