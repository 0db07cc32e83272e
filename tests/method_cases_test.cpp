// Every method on small random domains: the cases of fuzz/cases, by seeds.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "cases/method_case.h"
#include "littoral/methods.h"

namespace littoral {
namespace {

/// LITTORAL_CASES=FIRST:COUNT takes these seeds instead, to repeat a case or to run for long.
std::pair<unsigned long, unsigned long> seeds(unsigned long first, unsigned long count) {
  if (const char* text = std::getenv("LITTORAL_CASES"))
    std::sscanf(text, "%lu:%lu", &first, &count);
  return {first, count};
}

void run(unsigned long first, unsigned long count) {
  using Kind = fuzz::Outcome::Kind;
  std::map<Kind, unsigned long> counts;
  const auto begin = std::chrono::steady_clock::now();
  int failed = 0;
  for (unsigned long seed = first; seed < first + count && failed < 20; ++seed) {
    if (std::getenv("LITTORAL_CASES_VERBOSE")) std::fprintf(stderr, "seed %lu\n", seed);
    fuzz::Choices choose(seed);
    const fuzz::MethodCase given = fuzz::random_case(choose);
    const fuzz::Outcome outcome = fuzz::run_case(given, choose, 60);
    ++counts[outcome.kind];
    if (outcome.kind == Kind::broke_down)
      std::printf("seed %lu: %s\n%s", seed, outcome.error.c_str(),
                  std::getenv("LITTORAL_CASES_VERBOSE") ? description(given).c_str() : "");
    if (outcome.failures.empty()) continue;
    ++failed;
    std::string what;
    for (const std::string& failure : outcome.failures) what += failure + "\n";
    ADD_FAILURE() << "LITTORAL_CASES=" << seed << ":1\n" << what << "\n" << description(given);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::printf("%lu cases, %.0f a second: %lu answered, %lu refused, %lu broke down, %lu failed\n",
              count, double(count) / seconds.count(), counts[Kind::answered], counts[Kind::refused],
              counts[Kind::broke_down], counts[Kind::failed]);
  // An error says so where thin triangles leave nothing of a matrix, but that must stay rare.
  EXPECT_LE(counts[Kind::broke_down], 1 + count / 200);
}

TEST(MethodCases, KeepWhatIsPromised) {
  const auto [first, count] = seeds(0, 400);
  run(first, count);
}

TEST(MethodCases, ReachEveryMethod) {
  std::map<std::string, bool> reached;
  for (unsigned long seed = 0; seed < 1000; ++seed) {
    fuzz::Choices choose(seed);
    const fuzz::MethodCase given = fuzz::random_case(choose);
    reached[given.family + ": " + given.method] = true;
  }
  for (const MethodFamily& family : method_families())
    for (const MethodInfo& method : family.methods)
      EXPECT_TRUE(reached[family.title + ": " + method.name]) << family.title << " " << method.name;
}

}  // namespace
}  // namespace littoral
