#pragma once
// A triangulation as straight rays see it: what they enter through each edge, where paths bend.

#include <span>
#include <vector>

#include "domain/mesh/edge_sides.h"

namespace littoral {

/// Of triangles with the same three edges only the first can be entered: the others are as far.
struct PolyhedralPages {
  explicit PolyhedralPages(const IntrinsicTriangulation& T);

  /// The side of a triangle, as rays that enter through it see it: laid out along the edge.
  struct Page {
    int side;         // 3 triangle + k
    int far;          // vertex across
    bool turned;      // the side runs from the head of the edge to its tail
    double length, length1, length2;  // of this side and of the next two
    Complex apex;     // of `far`, the side on the real axis from 0 and the triangle above
  };
  std::span<const Page> at(int edge) const {
    return {pages.data() + offsets[edge], pages.data() + offsets[edge + 1]};
  }
  /// Sides across from the corners at a vertex: rays of the vertex leave through them.
  std::span<const int> around(int vertex) const {
    return {across.data() + corner_offsets[vertex], across.data() + corner_offsets[vertex + 1]};
  }
  /// Whether rays that come through a side have anywhere to go.
  bool leads_on(int edge, int side) const {
    const auto here = at(edge);
    return here.size() > 1 || (here.size() == 1 && here.front().side != side);
  }

  std::vector<int> offsets;         // edges + 1
  std::vector<Page> pages;
  std::vector<double> edge_length;  // edges; triangles may differ in the eleventh digit
  std::vector<char> bends;          // vertices; not inside a disk of at most a full turn
  std::vector<int> corner_offsets, across;
};

}  // namespace littoral
