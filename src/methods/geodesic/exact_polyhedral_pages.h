#pragma once
// A triangulation as straight rays see it: what they enter through each edge, where paths bend.

#include <algorithm>
#include <span>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/geodesic/polyhedral_window.h"

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
  /// The sides of triangles at an edge, 3 triangle + k, ascending.
  std::span<const int> at(const Edge& edge) const {
    return {pages.data() + edge.first_page, std::size_t(edge.n_pages)};
  }
  std::span<const int> at(int edge) const { return at(edges[edge]); }
  /// Which of the pages of an edge a side is; `no_page` if its triangle is left out or there are
  /// too many: rays that may return through their own triangle are no shorter for that.
  std::uint16_t page_of(const Edge& edge, int side) const {
    const auto sides = at(edge);
    const auto found = std::lower_bound(sides.begin(), sides.end(), side);
    if (found == sides.end() || *found != side) return Window::no_page;
    return std::uint16_t(std::min<std::ptrdiff_t>(found - sides.begin(), Window::no_page));
  }
  /// Sides across from the corners at a vertex: rays of the vertex leave through them.
  std::span<const int> around(int vertex) const {
    return {across.data() + corner_offsets[vertex], across.data() + corner_offsets[vertex + 1]};
  }
  /// Whether rays that come through a side have anywhere to go.
  bool leads_on(const Edge& edge, int side) const {
    return edge.n_pages > 1 || (edge.n_pages == 1 && pages[edge.first_page] != side);
  }

  std::vector<Edge> edges;
  std::vector<int> pages;  // by edge
  /// Whether paths bend at a vertex: never inside a disk of at most a full turn; inside a disk of
  /// more only behind the vertex, as seen from where they come.
  enum Bends : char { never = 0, anywhere = 1, behind = 2 };
  std::vector<char> bends;  // vertices
  std::vector<int> corner_offsets, across;
};

}  // namespace littoral
