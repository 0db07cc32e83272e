#pragma once
// What the timers beside other programs print of each step.

#include <chrono>
#include <cstdio>
#include <ctime>

/// Prints processor and clock seconds of a call, a line.
template <class Body>
void timed(const Body& body) {
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  body();
  std::printf("%.6f %.6f\n", double(std::clock() - cpu) / CLOCKS_PER_SEC,
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}
