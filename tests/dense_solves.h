#pragma once
// Dense linear algebra for references, compiled once: each decomposition costs seconds to compile.

#include <Eigen/Core>

namespace littoral::test {

/// An x with A x = b, where there is one: A may be singular and of any shape.
Eigen::MatrixXd dense_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);
Eigen::MatrixXcd dense_solve(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& b);

}  // namespace littoral::test
