#pragma once
// The cells of a nodal surface, prepared for quick use: gradients of functions at nodes, and means
// of vectors at nodes.

#include <cstdint>
#include <memory>

#include "domain/mesh/nodal_surface.h"
#include "operators/linear_map.h"

namespace littoral {

/// What is interpolated from the nodes of each patch to its cells.
class NodalCells {
 public:
  using Interpolation = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  explicit NodalCells(const NodalSurface& S);

  /// The nodes of patch p, in ascending order, with `turn` taking their vectors into the frame of
  /// the patch; and the real axis of each of its cells in that frame. Patch by patch, in order.
  void add_patch(const std::vector<int>& nodes, const VecXc& turn, const VecXc& axes);

  /// Gradient in each cell's frame of the linear function through the values at its corners (2
  /// cells x nodes).
  static LinearMap gradient(std::shared_ptr<const NodalCells> cells);
  /// Mean of the vectors at the corners of each cell, in its frame (2 cells x 2 nodes).
  static LinearMap mean(std::shared_ptr<const NodalCells> cells);

  int n_cells() const { return corner_.rows(); }
  int n_patches() const { return node_offsets_.size() - 1; }

 private:
  void mean_in_patch(int p, const VecXc& X, std::vector<Complex>& in_patch, VecXc& Y) const;
  Eigen::Index n_nodes() const { return P_.cols(); }

  Interpolation P_;                // vertices x nodes; the first rows are those of the identity
  MatX3i corner_;                  // cells x 3, vertices
  MatX3 slope_;                    // cells x 3: gradients of the hat functions of corners 1 and 2
                                   // are (slope 0, unit gradient) and (0, slope 2)
  VecXc to_frame_;                 // cells: from the frame of the patch to that of the cell
  std::vector<int> cell_offsets_;  // patches + 1
  std::vector<int> node_offsets_;  // patches + 1, into:
  std::vector<int> node_;          // nodes of patches
  std::vector<Complex> turn_;      // and the factors that take their vectors into the patch
};

}  // namespace littoral
