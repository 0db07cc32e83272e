#pragma once
// Scalar and matrix names used throughout. Shapes are written beside every declaration.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <complex>
#include <cstdint>
#include <vector>

namespace littoral {

using Complex = std::complex<double>;

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using VecX = Eigen::VectorXd;
using VecXi = Eigen::VectorXi;
using VecXc = Eigen::VectorXcd;
using MatX = Eigen::MatrixXd;

template <class T, int cols>
using Rows = Eigen::Matrix<T, Eigen::Dynamic, cols, Eigen::RowMajor>;
using MatX3 = Rows<double, 3>;  // n x 3, one point or vector a row
using MatX3i = Rows<int, 3>;    // n x 3, one triangle a row

using SpMat = Eigen::SparseMatrix<double>;    // compressed columns
using SpMatC = Eigen::SparseMatrix<Complex>;  // compressed columns
using Triplets = std::vector<Eigen::Triplet<double>>;

}  // namespace littoral
