#pragma once
// Cosine transforms of lines, several side by side.

#include <vector>

#include "littoral/types.h"

namespace littoral {

/// Orthonormal DCT-II of lines of n numbers, n >= 1. S is double or float. Immutable.
///
/// Even and odd frequencies see the even and the odd part of a line, and the even ones of an even
/// n are a transform of half the size. What is left are products with matrices, which run at the
/// speed of the machine's arithmetic, so that no size is slow: n^2 / 3 multiply-adds to n^2 / 2.
/// The same bits on every processor.
template <class S>
class CosineLines {
 public:
  static constexpr int width = 64 / sizeof(S);  // lines in a panel

  explicit CosineLines(int n);

  int size() const { return n_; }
  /// The frequency, 0 .. n - 1, at each place among the coefficients.
  const std::vector<int>& frequencies() const { return frequencies_; }

  /// Values -> coefficients, and back. Entry j of line r of a panel is panel[j * width + r]; `room`
  /// is as large.
  void forward(S* panel, S* room) const;
  void backward(S* panel, S* room) const;

 private:
  /// Entries first .. first + size - 1 of the folded line give as many coefficients there.
  struct Block {
    int first, size;
    std::vector<S> matrix, transposed;  // size x size, row-major
  };
  void add_block(int first, int size, int step, bool odd);
  void multiply(bool forward, const S* from, S* to) const;

  int n_;
  std::vector<int> folded_;  // entries that are folded in the middle, level by level
  std::vector<Block> blocks_;
  std::vector<int> frequencies_;
};

}  // namespace littoral
