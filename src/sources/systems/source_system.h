#pragma once
// Sources as the methods see them: a vector measure on the dofs and rows on the nodes. No mesh.

#include <utility>
#include <vector>

#include "littoral/types.h"

namespace littoral {

/// A vector for one dof, in its frame.
using DofVector = std::pair<int, Complex>;

/// Right-hand sides and constraint rows of one source set on one discretization.
///
/// Parts are connected parts of the curves, and isolated points. Batches collect parts none of
/// which is next to another, so that directions near one are not disturbed by another of its batch.
struct SourceSystem {
  std::vector<DofVector> X0;         // normals times the measure of the curves, integrated (eq. 11)
  std::vector<DofVector> X0_points;  // radial vectors of the isolated points (eq. 19)
  SpMat u0;  // nodes x batches: unsigned measure, integrated against the nodes' functions
  std::vector<char> batch_of_points;  // batches: 1 for points, 0 for curves
  VecX batch_value;                   // batches: the sources' value
  VecX d0;  // nodes: exact distance to the nearest point, counted from its value, on cells that
            // hold points; 0 elsewhere
  std::vector<int> near;   // those cells
  SpMat A;                 // rows x nodes: the value at a point of the source (eq. 14)
  VecX value;              // rows: what that is, less what d0 has of it
  VecX weight;             // rows: length the row stands for, in mean edge lengths
  std::vector<int> group;  // rows: connected part of the source
  int n_groups = 0;
  SpMat mean;                 // samples x nodes: values at midpoints of the source (Alg. 13, 18)
  VecX mean_weight;           // samples: lengths
  VecX mean_value;            // samples: of the source
  std::vector<char> reached;  // components that hold a source
  bool only_points = false;

  /// X0 + X0_points (2 dofs).
  VecX vectors(int dofs) const;
};

}  // namespace littoral
