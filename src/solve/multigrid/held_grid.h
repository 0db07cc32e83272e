#pragma once
// The Poisson equation of a grid at the rows of a source: what `solve_constrained` asks for.

#include <array>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/multigrid/cosine_transform.h"

namespace littoral {

/// L^+ of GridPoisson between the nodes that rows of A see, in single precision, which does for
/// multipliers to a tolerance of a hundredth of a spacing. Transforms leave out what no row sees.
/// One call at a time, as they share memory.
class HeldGrid {
 public:
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// A: rows x nodes of an n[0] x n[1] x n[2] grid, the first index fastest; it must stay.
  HeldGrid(std::array<int, 3> n, const Vec3& spacing, const Rows& A);

  /// A L^+ A^T v [rows]. Throws Cancelled.
  VecX across(const VecX& v, const Task& task);
  /// x := x - L^+ A^T v, x [nodes]. Throws Cancelled.
  void subtract(VecX& x, const VecX& v, const Task& task);

 private:
  void spread(const VecX& v);

  int line_;  // nodes along the first axis
  const Rows& A_;
  GridPoisson<float> poisson_;
  std::vector<char> used_;  // lines along the first axis
  Eigen::VectorXf nodes_;
};

}  // namespace littoral
