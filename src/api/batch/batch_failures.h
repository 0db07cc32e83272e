#pragma once
// Failures of many jobs, counted by what they say.

#include <map>
#include <string>
#include <vector>

#include "littoral/batch.h"

namespace littoral {

/// Counts failures whose messages differ in the input's name, in numbers and between quotes only.
class FailureCount {
 public:
  void add(const BatchJob& job, const BatchOutcome& outcome);
  /// The most frequent first.
  std::vector<BatchFailures> sorted() const;

 private:
  std::map<std::string, BatchFailures> by_text_;
};

}  // namespace littoral
