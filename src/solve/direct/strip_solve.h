#pragma once
// Many right-hand sides of a factor at once.

#include <span>
#include <vector>

#include "base/task.h"
#include "solve/direct/cholesky.h"
#include "solve/direct/strip.h"

namespace littoral {

/// Solves with a factor for strips whose rows have an order of their own. The columns of a strip do
/// not touch each other: each gets the same bits whatever the others hold.
class StripSolve {
 public:
  /// row_of: where the strips have each unknown. Shares the factor.
  StripSolve(Cholesky<double> factor, const std::vector<int>& row_of);

  /// x := A^-1 x. given: the rows of x that are not zero; empty: any. spare: used where the order
  /// of elimination is another than the strip's. Throws Cancelled.
  void operator()(Strip& x, std::span<const int> given, Strip& spare, const Task& task) const;

 private:
  void eliminate(Strip& x, std::span<const int> given, const Task& task) const;

  Cholesky<double> factor_;
  std::vector<int> place_;  // rows of a strip: their place in the order of elimination; empty: same
};

namespace dense {

/// A strip on one supernode: `own` are its n rows of the strip, row i of those below it is the
/// strip's row rows[i], and L is the top of `block` (height x n), A what is below. x := L^-1 x of
/// the own rows and x := x - A own of those below; and own := L^-T (own - A^T x).
void forward_strip(int n, int height, const double* block, double* own, double* strip,
                   const int* rows);
void backward_strip(int n, int height, const double* block, double* own, const double* strip,
                    const int* rows);

/// r := b - A x for a matrix by rows; sums (3 x strip_width) are those of the squares of r, b and
/// x, column by column. r may be null.
void residual_strip(int n, const int* begin, const int* to, const double* a, const double* b,
                    const double* x, double* r, double* sums);

/// The same where processors have nothing better.
void forward_plain(int n, int height, const double* block, double* own, double* strip,
                   const int* rows);
void backward_plain(int n, int height, const double* block, double* own, const double* strip,
                    const int* rows);
void residual_plain(int n, const int* begin, const int* to, const double* a, const double* b,
                    const double* x, double* r, double* sums);

}  // namespace dense

}  // namespace littoral
