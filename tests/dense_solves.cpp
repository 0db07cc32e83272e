#include "dense_solves.h"

#include <Eigen/LU>

namespace littoral::test {

Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  return A.fullPivLu().solve(b);
}

Eigen::MatrixXcd dense_solve(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& b) {
  return A.fullPivLu().solve(b);
}

}  // namespace littoral::test
