// Bytes as the choices that make a small domain, a method, sources and options: an answer that
// keeps what is promised, or one of the library's errors.

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "cases/method_case.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace littoral::fuzz;
  Choices choose(data, size);
  const MethodCase given = random_case(choose);
  const Outcome outcome = run_case(given, choose, 20);
  if (outcome.failures.empty()) return 0;
  for (const auto& what : outcome.failures) std::fprintf(stderr, "%s\n", what.c_str());
  std::fprintf(stderr, "%s\n", description(given).c_str());
  std::abort();
}
