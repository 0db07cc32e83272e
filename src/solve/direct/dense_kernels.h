#pragma once
// The dense kernels of a sparse factorization, on column-major blocks: BLAS where the build has
// one, Eigen's otherwise. `lda` and so on: distance between columns. Hermitian blocks: lower half.

#include "littoral/types.h"

namespace littoral::dense {

/// One thread of BLAS: results then do not depend on how many cores there are, and most blocks are
/// small. Independent blocks run side by side instead. All below do it; before a process is forked
/// it keeps OpenBLAS from starting its threads again in the child.
void use_one_thread();

/// For a program of our own: ends the threads that OpenBLAS starts as it is loaded. They wait for
/// work actively, on cores that the program has other use for (80 ms were seen).
void end_blas_threads();

/// What a thread that calls these reserves [bytes]: its stack and OpenBLAS's buffer, little of
/// which is touched. OpenBLAS waits for ever where it cannot have it.
double bytes_of_a_thread();

/// A = L L^*, n x n, in place. Returns false if a pivot is not positive and finite.
template <class Scalar>
bool cholesky(int n, Scalar* A, int lda);

/// B := B L^-*, B m x n.
template <class Scalar>
void solve_right(int m, int n, const Scalar* L, int ldl, Scalar* B, int ldb);

/// C := C - A A^*, A n x k; lower half of C only.
template <class Scalar>
void subtract_square(int n, int k, const Scalar* A, int lda, Scalar* C, int ldc);

/// C := C - A B^*, A m x k, B n x k.
template <class Scalar>
void subtract_product(int m, int n, int k, const Scalar* A, int lda, const Scalar* B, int ldb,
                      Scalar* C, int ldc);

/// x := L^-1 x and x := L^-* x, x n x k.
template <class Scalar>
void forward(int n, int k, const Scalar* L, int ldl, Scalar* x, int ldx);
template <class Scalar>
void backward(int n, int k, const Scalar* L, int ldl, Scalar* x, int ldx);

/// Columns of a supernode up to which calls cost more than loops.
inline constexpr int small_supernode = 24;

/// Factors the first n columns of a small front in place, L on top of A, and C := C - A A^*, lower
/// half, for what is below (height - n square). Returns false if a pivot is not positive and
/// finite.
template <class Scalar>
bool factor_small(int n, int height, Scalar* block, Scalar* C);

/// One right-hand side on a small supernode, where calls would cost more than their work: L is the
/// top of `block` (height x n), A what is below. x := L^-1 x, then y := A x; and, of v = (x, y)
/// (height), x := L^-* (x - A^* y).
template <class Scalar>
void forward_small(int n, int height, const Scalar* block, Scalar* x, Scalar* y);
template <class Scalar>
void backward_small(int n, int height, const Scalar* block, Scalar* v);

/// y := A x (A m x n, x n x k) and x := x - A^* y.
template <class Scalar>
void times(int m, int n, int k, const Scalar* A, int lda, const Scalar* x, int ldx, Scalar* y,
           int ldy);
template <class Scalar>
void subtract_adjoint(int m, int n, int k, const Scalar* A, int lda, const Scalar* y, int ldy,
                      Scalar* x, int ldx);

}  // namespace littoral::dense
