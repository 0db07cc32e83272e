#pragma once
// Products of dense blocks, which the factors of large meshes spend their time in: blocks are
// copied to where the kernels read them one after the other, and kernels keep a tile of the product
// in registers (K. Goto, R. van de Geijn, Anatomy of high-performance matrix multiplication, 2008).

#include <cstddef>

#include "base/kernel_choice.h"

namespace littoral::dense {

/// Numbers of a block or its adjoint: (i, j) is at[i * row + j * column], conjugated if so.
template <class Scalar>
struct Operand {
  const Scalar* at;
  std::ptrdiff_t row, column;
  bool conjugated = false;
};

/// What a thread that calls these keeps for itself [bytes].
inline constexpr std::size_t bytes_of_copies = 2640 << 10;

struct ProductOptions {
  bool lower = false;  // C's part on and below its diagonal, which is made real, and nothing else
  bool from_zero = false;  // whatever C holds
  Instructions allowed = Instructions::any;
};

/// C := C - A B, A m x k, B k x n, C m x n by columns. The same bits with AVX2 and AVX-512. Of
/// complex numbers an entry's error is bounded by the moduli of what it sums, not part by part: its
/// parts come from three products of real numbers (Higham, Accuracy and stability of numerical
/// algorithms, 2002, ch. 23).
template <class Scalar>
void subtract_product(int m, int n, int k, const Operand<Scalar>& A, const Operand<Scalar>& B,
                      Scalar* C, int ldc, const ProductOptions& options = {});

/// B := B L^-*, B m x n, L lower triangular with a real diagonal.
template <class Scalar>
void solve_right(int m, int n, const Scalar* L, int ldl, Scalar* B, int ldb,
                 Instructions allowed = Instructions::any);

}  // namespace littoral::dense
