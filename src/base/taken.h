#pragma once
// Eigen 3.4 copies sparse matrices that are moved.

#include <memory>

namespace littoral {

/// What A held, which is empty then.
template <class Matrix>
Matrix taken(Matrix& A) {
  Matrix out;
  out.swap(A);
  return out;
}

/// The same, shared.
template <class Matrix>
std::shared_ptr<const Matrix> shared_taken(Matrix& A) {
  const auto out = std::make_shared<Matrix>();
  out->swap(A);
  return out;
}

}  // namespace littoral
