#pragma once
// Whether iterations come nearer to their end fast enough to go on with them.

#include "base/index.h"

namespace littoral {

/// Looks at a residual at marks, each one and a half times as far as the one before.
///
/// Needles leave round-off above the tolerance, which no number of iterations gets below, or a
/// residual that falls ever more slowly. So from mark to mark it must have fallen so much that, at
/// this pace, ten times as many iterations would do.
class Pace {
 public:
  /// Is it worth to go on after so many iterations, where the residual (1: done) is this one?
  bool hopeful(int iterations, double residual);

 private:
  static constexpr double further_ = 1.5;  // from mark to mark
  double mark_ = 10'000 / further_, least_ = infinity, least_at_mark_ = infinity;
};

}  // namespace littoral
