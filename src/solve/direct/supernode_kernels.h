#pragma once
// What is done to one supernode's block of a sparse factor: L of its columns on top, A below,
// column-major, `height` rows in all.

#include "littoral/types.h"

namespace littoral::dense {

/// A = L L^*, n x n, in place. Returns false if a pivot is not positive and finite.
template <class Scalar>
bool cholesky(int n, Scalar* A, int lda);

/// Columns of a supernode up to which one is factored by columns, without products of blocks.
inline constexpr int small_supernode = 24;

/// Factors the first n columns of a small front in place, L on top of A, and C := -A A^*, lower
/// half, for what is below (height - n square). Returns false if a pivot is not positive and
/// finite.
template <class Scalar>
bool factor_small(int n, int height, Scalar* block, Scalar* C);

/// x := L^-1 x, then y := A x; x n x k, y height - n x k.
template <class Scalar>
void forward(int n, int height, int k, const Scalar* block, Scalar* x, int ldx, Scalar* y, int ldy);

/// Of v = (x, y), height x k: x := L^-* (x - A^* y).
template <class Scalar>
void backward(int n, int height, int k, const Scalar* block, Scalar* v, int ldv);

}  // namespace littoral::dense
