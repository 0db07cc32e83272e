#pragma once
// (M + t L) x = b for small t, right however fast x decays.

#include <memory>
#include <vector>

#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/solve/cholesky.h"

namespace littoral {

/// A decaying solution in layers, each at a scale of its own: block i is scale[0] * ... *
/// scale[layer[i]] * x_i. Layer -1: no source reaches the block.
template <class Scalar>
struct LayeredField {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> x;
  std::vector<int> layer;     // blocks
  std::vector<double> scale;  // layers, scale[0] = 1

  /// The entries of layer p and, in its units, of layer p + 1; 0 elsewhere.
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> around_layer(int p) const;
};

/// One factorization of a positive definite matrix whose inverse decays exponentially; immutable.
template <class Scalar>
class HeatSystem {
 public:
  using Matrix = Eigen::SparseMatrix<Scalar>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// lower: the matrix's lower triangle; unknowns come in blocks of `block` (a real matrix of
  /// complex unknowns has 2).
  HeatSystem(Matrix lower, int block, const Task& task);

  /// Solves by renormalised passes: the first solve is good to 1e-100 of its largest entry; the
  /// rest is solved again from the residual that truncating there leaves, which lives next to the
  /// front, scaled to 1; and so on. `piece` names the block's connected piece; each piece of b is
  /// scaled to largest entry 1 first, as pieces do not interact.
  LayeredField<Scalar> solve(const Vector& b, const std::vector<int>& piece, const Task& task,
                             Report& report) const;

  const Matrix& matrix() const { return *A_; }
  int block() const { return block_; }
  double nonzeros() const { return factor_.nonzeros(); }

 private:
  std::shared_ptr<const Matrix> A_;
  int block_;
  Cholesky<Scalar> factor_;
};

extern template struct LayeredField<double>;
extern template struct LayeredField<Complex>;
extern template class HeatSystem<double>;
extern template class HeatSystem<Complex>;

}  // namespace littoral
