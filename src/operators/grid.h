#pragma once
// The calculus of a regular grid, without matrices: values at nodes, gradients at grid edges.

#include <functional>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "littoral/volume.h"
#include "operators/calculus.h"

namespace littoral {

using Directions = Rows<float, 3>;  // nodes x 3

/// G^T Y with G the forward differences along grid edges and Y at their midpoints, the mean of both
/// ends: the weak form of -div Y whose natural boundary condition is that of eq. 3. Nodes; sums to
/// 0.
VecX grid_divergence(const Grid& grid, const Directions& Y, const Task& task = {});

/// The same as assembled operators, for methods that multiply often: a cell at every node, whose
/// gradient (three numbers) is that of the grid edges that leave the node along the axes, 0 where
/// none does; cell and node have the volume of a cube of the grid.
Calculus grid_calculus(const Grid& grid);

/// Bytes of that for so many nodes, with what `sharpen` needs on it.
double grid_sharpening_memory(double nodes);

/// Values at points from values at the nodes, linear along each axis. One row per grid cell that
/// holds points: the mean over these points by weight, so that rows are independent (a point of
/// which a cell has many would be held by many rows, and the cell would lock). Points outside the
/// box are left out. Where points have parts a row has those of one.
struct GridRows {
  Eigen::SparseMatrix<double, Eigen::RowMajor> A;  // rows x nodes, row sums 1
  VecX weight;                                     // rows: sum of the points' weights
  std::vector<int> part;                           // rows; empty: points have none
  VecX value;                                      // rows: of the points in the mean; 0 of none
};
GridRows grid_rows(const Grid& grid, const MatX3& points, const VecX& weights,
                   const std::vector<int>& part = {}, const std::vector<double>& value = {});

/// What is known at one place.
struct Flow {
  Vec3 direction = Vec3::Zero();  // unit; zero where there is none
  double distance = 0;            // to the nearest source [length]
};
/// Puts what is known at n places into `out`; neighbours in the list are mostly so in space.
using Sample = std::function<void(const Vec3* places, int n, Flow* out)>;

/// A unit vector at each node from one that is dear to evaluate and smooth far from the sources.
///
/// Evaluates on a lattice that is as coarse as `sample` allows and halves its cells until the
/// normalised linear interpolation agrees with the value at the middle of a cell (to 1 %), and
/// everywhere within a cell's diagonal of the sources. Reports the share of nodes evaluated.
Directions sample_directions(const Grid& grid, const Sample& sample, const Task& task,
                             Report& report);

}  // namespace littoral
