#pragma once
// A preconditioner for multipliers along a source in a regular grid: two levels.

#include <array>
#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/multigrid/held_grid.h"

namespace littoral {

/// An approximate inverse of S = A L^+ A^T + diag(softness) for `solve_constrained`, L the grid's
/// (GridPoisson), which A L^+ A^T makes an operator of order -1 on the source: a layer of wave
/// number k has the values V / (2 k), V the volume of a cell. Rows of one block of 4 x 4 x 4 cells
/// share a multiplier by weight, for which S is solved on a grid of four times the spacing; what
/// varies within blocks is divided by the value of their wave numbers. Symmetric and positive on
/// multipliers of sum zero but for the tolerance of the inner iteration. One call at a
/// time.
class GridMultipliers {
 public:
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// A: rows x nodes of an n[0] x n[1] x n[2] grid, the first index fastest, each row within a
  /// cell, row sums 1. weight: rows, > 0 (the source's area in the cell). softness: rows, >= 0.
  GridMultipliers(const GridMultipliers&) = delete;
  GridMultipliers& operator=(const GridMultipliers&) = delete;
  ~GridMultipliers() = default;
  GridMultipliers(std::array<int, 3> n, const Vec3& spacing, const Rows& A, const VecX& weight,
                  const VecX& softness);

  /// S^-1 residual, nearly [rows]. Throws Cancelled.
  VecX operator()(const VecX& residual, const Task& task) const;

 private:
  std::vector<int> block_;          // rows: coarse row
  VecX share_;                      // rows: its weight in that of its block
  VecX inverse_;                    // rows: multiplier for a residual that varies within a block
  Rows A_;                          // coarse rows x coarse nodes
  VecX softness_;                   // coarse rows
  double volumes_ = 1;              // of a cell, fine over coarse
  std::unique_ptr<HeldGrid> held_;  // of A_
};

}  // namespace littoral
