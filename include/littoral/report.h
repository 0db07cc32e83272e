#pragma once
// What a computation says about itself beside its answer.

#include <string>
#include <utility>
#include <vector>

namespace littoral {

/// A sentence about what is doubtful, and its code, which stays the same when the wording changes.
struct Warning {
  std::string code, text;

  operator const std::string&() const { return text; }
};

/// Facts gathered while a method runs; ordered as they were added. Turned into JSON by the front
/// ends.
struct Report {
  std::string method;
  std::string domain;
  // Or "not converged": the answer is then the best iterate; or "uncertain": see the warnings.
  std::string status = "converged";
  std::vector<std::pair<std::string, std::string>> options;  // name, value as text
  std::vector<std::pair<std::string, double>> sizes;         // e.g. "vertices"
  std::vector<std::pair<std::string, double>> timings;       // stage, seconds
  std::vector<std::pair<std::string, double>> iterations;    // loop, count
  std::vector<std::pair<std::string, double>> residuals;     // equation, relative residual
  std::vector<Warning> warnings;
  std::vector<int> unreachable_components;  // components of the domain whose values are +inf

  /// The page of messages explains the code.
  void warn(std::string code, std::string text) {
    warnings.push_back({std::move(code), std::move(text)});
  }
  void merge(const Report& other);
};

}  // namespace littoral
