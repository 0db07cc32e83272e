#pragma once
// Oriented points as right-hand side and constraint rows on a tet mesh.

#include <functional>
#include <vector>

#include "domain/tet/tet_lattice.h"
#include "operators/tet_operators.h"
#include "sources/space/oriented_points.h"

namespace littoral {

struct TetSourceSystem {
  MatX3 X0;                 // faces x 3: sum of A n phi_f(p)
  SpMat A;                  // rows x vertices: mean value at the samples of one group, row sums 1
  VecX weight;              // rows: area
  int outside = 0;          // samples in no tet
  std::vector<int> part{};  // rows: of the source; empty: it is one
  VecX value;               // rows: what distance is counted from, in the mean
};

/// `places` says where each sample lies, `group` which of them share a constraint row: a row each
/// would hold every value around them; `part`, to which part of the source each belongs (empty: it
/// is one), which a row holds one of; `value`, from what distance is counted there (empty: 0).
TetSourceSystem tet_source_system(const TetMesh& mesh, const TetOperators& ops,
                                  const OrientedPoints& source, const std::vector<TetPoint>& places,
                                  const std::vector<int>& group, const std::vector<int>& part = {},
                                  const std::vector<double>& value = {});

/// Each vertex a row of its own, all of one weight; X0 is empty. values: as there.
TetSourceSystem vertex_source_system(const TetOperators& ops, std::vector<int> vertices,
                                     std::vector<double> values = {});

}  // namespace littoral
