#pragma once
// Large symmetric positive definite systems: conjugate gradients, preconditioned by multigrid and
// exact where multigrid is not at home.

#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "solve/multigrid/multigrid.h"

namespace littoral {

/// A Laplacian with penalties on few unknowns; immutable. The unknowns around the penalties form a
/// band that is solved exactly before and after each multigrid cycle.
class BandedMultigrid {
 public:
  /// lower: lower triangle, given up once it is read. stiff: unknowns with penalties.
  BandedMultigrid(SpMat&& lower, const std::vector<int>& stiff, const Task& task);

  /// x with A x = b up to `tolerance` in the energy norm, as the preconditioner measures it.
  /// Iterations go to the report, with the status "not converged" where 500 do not suffice.
  /// Throws Cancelled within 0.2 s of a request.
  VecX solve(VecX b, double tolerance, const Task& task, Report& report) const;

  const SpRows& matrix() const { return multigrid_.matrix(); }
  double nonzeros() const;

 private:
  struct Work {
    Multigrid::Work cycle;
    VecX r;  // all unknowns
    VecX in_band;
  };
  void precondition(const VecX& b, VecX& x, Work& work, const Task& task) const;

  Multigrid multigrid_;
  std::vector<int> band_;  // unknowns, ascending
  std::shared_ptr<const Cholesky<double>> band_factor_;
};

}  // namespace littoral
