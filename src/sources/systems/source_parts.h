#pragma once
// Sources that are diffused together: none next to another.

#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"

namespace littoral {

/// A vertex beside a part of the source.
struct PartStart {
  int vertex;
  int part;
  double distance;  // along the surface [T.unit]
};

/// A batch for each part such that, where 16 batches suffice, no part shares a batch with one whose
/// region of nearest vertices touches its own, nor with one that touches such a region. Regions are
/// by shortest paths along edges. With up to 4 parts each has its own batch.
std::vector<int> batches_of_parts(const IntrinsicTriangulation& T,
                                  const std::vector<PartStart>& starts, int n_parts);

}  // namespace littoral
