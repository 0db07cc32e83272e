#pragma once
// Sparse matrices that can be moved.

#include <utility>

namespace littoral {

/// A sparse matrix of Eigen that hands over what it holds when it is moved, as members of structs
/// are: Eigen 3.4 copies it.
template <class Matrix>
struct Movable : Matrix {
  using Matrix::Matrix;
  Movable() = default;
  Movable(const Movable&) = default;
  Movable(Movable&& other) noexcept { this->swap(other); }
  Movable(Matrix&& other) noexcept { this->swap(other); }  // NOLINT(google-explicit-constructor)
  Movable& operator=(const Movable&) = default;
  Movable& operator=(Movable&& other) noexcept {
    this->swap(other);
    return *this;
  }
  Movable& operator=(Matrix&& other) noexcept {
    this->swap(other);
    return *this;
  }
  using Matrix::operator=;
};

}  // namespace littoral
