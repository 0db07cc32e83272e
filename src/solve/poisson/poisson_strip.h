#pragma once
// Poisson problems without constraints for strips of right-hand sides.

#include <array>
#include <vector>

#include "base/task.h"
#include "solve/direct/strip_solve.h"
#include "solve/poisson/poisson.h"

namespace littoral {

/// What Poisson::solve finds, up to a constant for each component; immutable.
class StripPoisson {
 public:
  /// poisson: with an exact factor (DefiniteSystem::exact_factor). row_of: where the strips have
  /// each unknown.
  StripPoisson(const Poisson& poisson, const std::vector<int>& row_of);

  /// x with L x = b, refined until the residual is down to round-off; b sums to 0 over each
  /// component. Returns the relative residual of each column, not a number where a solve of its own
  /// must see to it. Throws Cancelled.
  std::array<double, strip_width> solve(const Strip& b, Strip& x, Strip& spare,
                                        const Task& task) const;

 private:
  StripSolve solve_;
  double largest_;               // on the diagonal
  std::vector<int> begin_, to_;  // the matrix by rows, in the order of the strips
  std::vector<double> value_;
};

}  // namespace littoral
