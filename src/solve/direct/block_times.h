#pragma once
// A block times a vector, four or eight numbers at once where the processor can, which is asked
// when the program runs.

#include "base/kernel_choice.h"

namespace littoral::dense {

enum class Into { replaced, added, subtracted };

/// y := A x, y + A x or y - A x, A m x n. The same bits by four and by eight numbers.
template <Into into, class Scalar>
void times(int m, int n, const Scalar* A, int lda, const Scalar* x, Scalar* y,
           Instructions allowed = Instructions::any);

/// x := x - A^* y, A m x n; n is four at most.
template <class Scalar>
void subtract_adjoint(int m, int n, const Scalar* A, int lda, const Scalar* y, Scalar* x,
                      Instructions allowed = Instructions::any);

}  // namespace littoral::dense
