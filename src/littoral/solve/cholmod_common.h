#pragma once
// CHOLMOD's workspace and views of Eigen's matrices, for the files that call CHOLMOD.
#if LITTORAL_CHOLMOD

#include <cholmod.h>

#include "littoral/base/types.h"

namespace littoral {

/// A workspace set up for supernodal L L^* with METIS ordering and one thread of BLAS.
struct CholmodCommon {
  cholmod_common c;
  CholmodCommon();
  ~CholmodCommon();
  CholmodCommon(const CholmodCommon&) = delete;
  CholmodCommon& operator=(const CholmodCommon&) = delete;

  bool out_of_memory() const {
    return c.status == CHOLMOD_OUT_OF_MEMORY || c.status == CHOLMOD_TOO_LARGE;
  }
};

template <class Scalar>
constexpr int cholmod_xtype = std::is_same_v<Scalar, double> ? CHOLMOD_REAL : CHOLMOD_COMPLEX;

/// The lower triangle of a symmetric matrix, not copied.
template <class Scalar>
cholmod_sparse cholmod_lower(const Eigen::SparseMatrix<Scalar>& lower) {
  cholmod_sparse A{};
  A.nrow = A.ncol = static_cast<std::size_t>(lower.rows());
  A.nzmax = static_cast<std::size_t>(lower.nonZeros());
  A.p = const_cast<int*>(lower.outerIndexPtr());
  A.i = const_cast<int*>(lower.innerIndexPtr());
  A.x = const_cast<Scalar*>(lower.valuePtr());
  A.stype = -1;
  A.itype = CHOLMOD_INT;
  A.xtype = cholmod_xtype<Scalar>;
  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = A.packed = 1;
  return A;
}

/// A dense matrix, not copied.
template <class Matrix>
cholmod_dense cholmod_columns(const Matrix& b) {
  using Scalar = typename Matrix::Scalar;
  cholmod_dense B{};
  B.nrow = B.d = static_cast<std::size_t>(b.rows());
  B.ncol = static_cast<std::size_t>(b.cols());
  B.nzmax = B.nrow * B.ncol;
  B.x = const_cast<Scalar*>(b.data());
  B.xtype = cholmod_xtype<Scalar>;
  B.dtype = CHOLMOD_DOUBLE;
  return B;
}

}  // namespace littoral

#endif
