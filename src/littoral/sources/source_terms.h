#pragma once
// Sources as the methods see them: a vector measure on the carriers and rows on the nodes. No mesh.

#include <vector>

#include "littoral/base/types.h"

namespace littoral {

/// Right-hand sides and constraint rows of one source set on one discretization.
struct SourceTerms {
  VecX X0;  // 2 carriers: normals times the measure of the source, integrated (eq. 11, 19)
  VecX u0;  // nodes: the unsigned measure of the source, integrated against the nodes' functions
  SpMat A;  // rows x nodes: the value at a point of the source (eq. 14)
  VecX weight;             // rows: length the row stands for, in mean edge lengths
  std::vector<int> group;  // rows: connected part of the source
  int n_groups = 0;
  SpMat mean;                 // samples x nodes: values at midpoints of the source (Alg. 13, 18)
  VecX mean_weight;           // samples: lengths
  std::vector<char> reached;  // components that hold a source
  bool only_points = false;
};

}  // namespace littoral
