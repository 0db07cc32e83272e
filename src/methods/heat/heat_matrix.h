#pragma once
// M + t L for the vector heat step (signed heat method, eq. 12), whole or row by row.

#include <functional>
#include <memory>

#include "base/task.h"
#include "solve/direct/hermitian_rows.h"

namespace littoral {

/// Lower triangle, in the place of L, as Eigen would copy it. M: per block of unknowns; those
/// without mass get a unit diagonal.
template <class Scalar>
std::shared_ptr<const Eigen::SparseMatrix<Scalar>> heat_matrix(
    const std::function<Eigen::SparseMatrix<Scalar>(const Task&)>& L, const VecX& M, double t,
    const Task& task);

/// The same made row by row. M is kept by who calls.
std::shared_ptr<const HermitianRows<Complex>> heat_rows(
    std::shared_ptr<const HermitianRows<Complex>> L, const VecX& M, double t);

}  // namespace littoral
