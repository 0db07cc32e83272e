#include "base/dense_decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace littoral {

Eigenvectors3 symmetric_eigenvectors(const Eigen::Matrix3d& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Vec3 least_eigenvector(const Eigen::Matrix3d& A) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(A);
  return eigen.eigenvectors().col(0);
}

Vec3 solve_symmetric(const Eigen::Matrix3d& A, const Vec3& b) {
  if (!(A.fullPivLu().rcond() > 1e-12)) return Vec3::Zero();
  return Eigen::LDLT<Eigen::Matrix3d>(A).solve(b);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& S) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (S + S.transpose()));
  const double least = 1e-11 * eigen.eigenvalues().cwiseAbs().maxCoeff();
  const VecX inverse =
      eigen.eigenvalues().unaryExpr([least](double x) { return x > least ? 1 / x : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

struct SymmetricFactor::Factor {
  Eigen::LDLT<Eigen::MatrixXd> ldlt;
};

SymmetricFactor::SymmetricFactor(const Eigen::MatrixXd& A)
    : factor_(std::make_shared<const Factor>(Factor{Eigen::LDLT<Eigen::MatrixXd>(A)})) {}

VecX SymmetricFactor::solve(const VecX& b) const { return factor_->ldlt.solve(b); }

}  // namespace littoral
