#pragma once
// Bounds of single values beside an energy of gradients, for splitting methods: cells of their own
// after those of the gradient, of which the first number counts.

#include <vector>

#include "littoral/types.h"
#include "solve/direct/sparse_rows.h"
#include "solve/optimization/gradient_energy.h"

namespace littoral {

/// Another energy on the first cells; on cell `cells` + i, 0 <= sign_i z <= bound_i.
class BoundedEnergy : public GradientEnergy {
 public:
  /// `inner` must outlive this.
  BoundedEnergy(const GradientEnergy& inner, int dim, Eigen::Index cells, std::vector<int> sign,
                VecX bound);
  void prox(Eigen::Index cell, double rho, const double* w, double* z) const override;
  void prox_all(Eigen::Index first, Eigen::Index count, int dim, const double* rho, const double* w,
                double* z) const override;
  double value(Eigen::Index cell, const double* z) const override;
  double conjugate(Eigen::Index cell, const double* y) const override;
  /// 0 for a bound: what is beyond it is put right by SplitProblem::allowed.
  double gauge(Eigen::Index cell, const double* z) const override;

 private:
  const GradientEnergy& inner_;
  int dim_;
  Eigen::Index cells_;
  std::vector<int> sign_;
  VecX bound_;
};

/// G, and below it each row of R as the first of `dim` rows.
SpRows stacked(const SpRows& G, const SpMat& R, int dim);

}  // namespace littoral
