#pragma once
// Graphs in compressed rows.

#include <vector>

#include "base/large_vector.h"

namespace littoral {

/// An undirected graph without loops: each edge is in the rows of both its ends. Vertices and edges
/// have weights; those of edges are left out where all are one.
struct Graph {
  std::vector<int> begin{0};         // rows: vertices + 1
  UnclearedVector<int> to;           // begin.back() of them; what follows means nothing
  std::vector<int> weight;           // vertices
  UnclearedVector<int> edge_weight;  // as `to`, or empty

  int size() const { return static_cast<int>(weight.size()); }
};

}  // namespace littoral
