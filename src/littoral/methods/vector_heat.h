#pragma once
// Step I: one backward Euler step of vector diffusion, right at any distance from the source.

#include <memory>
#include <vector>

#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/operators/calculus.h"
#include "littoral/solve/cholesky.h"

namespace littoral {

/// (M + t L) X = X0 (eq. 12) on one factorization; immutable.
class VectorHeat {
 public:
  VectorHeat(const VectorDiffusion& V, double t, const Task& task);

  /// Diffused vectors (2 carriers). Only directions matter to the caller: where the field would leave
  /// the range of double precision it is continued from its own front at a new scale, so that no
  /// direction is lost however far from the source. Carriers on pieces without a source stay 0.
  VecX diffuse(const VecX& X0, const Task& task, Report& report) const;

  /// The same with X held at `held` (2 carriers) where `hold` (carriers) is set.
  VecX diffuse_held(const VecX& held, const std::vector<char>& hold, const Task& task,
                    Report& report) const;

  double nonzeros() const;

 private:
  template <class Scalar>
  struct System;
  template <class Scalar>
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  template <class Scalar>
  VecX run(const System<Scalar>& system, const VecX& X0, const Task& task, Report& report) const;

  int n_ = 0;
  std::vector<int> piece_;
  std::shared_ptr<const System<Complex>> complex_;
  std::shared_ptr<const System<double>> real_;
};

}  // namespace littoral
