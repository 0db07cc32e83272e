#pragma once
// Seconds per stage, for reports.

#include <chrono>
#include <string>
#include <utility>

#include "littoral/report.h"

namespace littoral {

/// Adds the seconds between its construction and destruction to a report under `stage`.
class Stopwatch {
 public:
  Stopwatch(Report& report, std::string stage)
      : report_(report), stage_(std::move(stage)), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    const std::chrono::duration<double> d = std::chrono::steady_clock::now() - start_;
    report_.timings.emplace_back(stage_, d.count());
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Report& report_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace littoral
