#pragma once
// A triangulation as straight rays see it: what they enter through each edge, where paths bend.

#include <span>
#include <vector>

#include "domain/mesh/edge_sides.h"

namespace littoral {

/// Of triangles with the same three edges only the first can be entered: the others are as far.
struct PolyhedralPages {
  explicit PolyhedralPages(const IntrinsicTriangulation& T);

  struct Edge {
    double length;  // triangles may differ in the eleventh digit
    double wait;    // half of the shortest side of its triangles
    int tail, head;
    int first_page, n_pages;
  };
  /// The side of a triangle, as rays that enter through it see it: laid out along the edge.
  struct Page {
    int side;                         // 3 triangle + k
    int far;                          // vertex across
    double length, length1, length2;  // of this side and of the next two
    Complex apex;                     // of `far`, the side on the real axis from 0, triangle above
    int edge1, edge2;                 // of the next two sides
    bool turned, turned1, turned2;    // the sides run from the head of their edge to its tail
  };
  std::span<const Page> at(int edge) const {
    return {pages.data() + edges[edge].first_page, std::size_t(edges[edge].n_pages)};
  }
  /// Sides across from the corners at a vertex: rays of the vertex leave through them.
  std::span<const int> around(int vertex) const {
    return {across.data() + corner_offsets[vertex], across.data() + corner_offsets[vertex + 1]};
  }
  /// Whether rays that come through a side have anywhere to go.
  bool leads_on(const Edge& edge, int side) const {
    return edge.n_pages > 1 || (edge.n_pages == 1 && pages[edge.first_page].side != side);
  }

  std::vector<Edge> edges;
  std::vector<Page> pages;  // by edge
  std::vector<char> bends;  // vertices; not inside a disk of at most a full turn
  std::vector<int> corner_offsets, across;
};

}  // namespace littoral
