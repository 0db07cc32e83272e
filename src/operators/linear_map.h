#pragma once
// A linear operator that need not be a matrix.

#include <functional>

#include "littoral/types.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

/// x -> A x and y -> A^T y, for operators applied from their mesh (or grid) without assembly.
struct LinearMap {
  Eigen::Index rows = 0, cols = 0;
  std::function<VecX(const VecX&)> apply;    // cols -> rows
  std::function<VecX(const VecX&)> adjoint;  // rows -> cols; may be empty
  std::function<SpRows()> matrix;            // rows x cols, for who multiplies often; may be empty
};

}  // namespace littoral
