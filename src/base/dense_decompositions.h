#pragma once
// Eigen's decompositions of small dense matrices, compiled once: each costs seconds to compile.

#include <memory>

#include "littoral/types.h"

namespace littoral {

/// Eigenvalues in increasing order, and the unit eigenvectors as columns.
struct Eigenvectors3 {
  Vec3 values;
  Eigen::Matrix3d vectors;
};
Eigenvectors3 symmetric_eigenvectors(const Eigen::Matrix3d& A);

/// The eigenvector of the least eigenvalue by the closed formula: fast, to half the digits.
Vec3 least_eigenvector(const Eigen::Matrix3d& A);

/// x with A x = b for a symmetric A; nothing but zeros where A is singular to 12 digits.
Vec3 solve_symmetric(const Eigen::Matrix3d& A, const Vec3& b);

/// Inverse of a semidefinite matrix, 0 on its null space: dependent rows do no harm.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& S);

/// The factors L D L^T of a symmetric matrix, for any number of right-hand sides.
class SymmetricFactor {
 public:
  explicit SymmetricFactor(const Eigen::MatrixXd& A);
  VecX solve(const VecX& b) const;

 private:
  struct Factor;
  std::shared_ptr<const Factor> factor_;
};

}  // namespace littoral
