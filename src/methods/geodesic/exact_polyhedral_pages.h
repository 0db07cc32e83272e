#pragma once
// A triangulation as straight rays see it: what they enter through each edge, where paths bend.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "base/large_vector.h"
#include "base/same_rows.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/geodesic/polyhedral_window.h"

namespace littoral {

/// Of triangles with the same three edges only the first can be entered: the others are as far.
struct PolyhedralPages {
  explicit PolyhedralPages(const IntrinsicTriangulation& T);

  /// What rays need of a triangle and of an edge, each in one line of the processor's cache.
  struct alignas(64) Triangle {
    std::array<double, 3> length;     // of side k; vertices k and k + 1 are its ends
    std::array<int, 3> vertex, edge;  // the edge of side k
    std::array<signed char, 3> along;
  };
  struct alignas(32) Edge {
    double length;  // triangles may differ in the eleventh digit
    double wait;    // half of the shortest side of its triangles
    int tail, head;
    std::array<int, 2> sides;  // {side, side}, {side, -1}, {-1, -1} or {first in `pages`, -number}

    std::size_t n_pages() const {
      return sides[1] >= 0 ? 2 : sides[1] < -1 ? std::size_t(-sides[1]) : sides[0] >= 0 ? 1 : 0;
    }
  };
  /// The sides of triangles at an edge, 3 triangle + k, ascending.
  std::span<const int> at(const Edge& edge) const {
    return {edge.sides[1] < -1 ? pages.data() + edge.sides[0] : edge.sides.data(), edge.n_pages()};
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
    return edge.sides[1] != -1 || (edge.sides[0] >= 0 && edge.sides[0] != side);
  }

  LargeVector<Triangle> triangles;
  LargeVector<Edge> edges;
  std::vector<int> pages;  // of edges with more than two
  /// Whether paths bend at a vertex: never inside a disk of at most a full turn; inside a disk of
  /// more only behind the vertex, as seen from where they come.
  enum Bends : char { never = 0, anywhere = 1, behind = 2 };
  std::vector<char> bends;         // vertices
  std::vector<float> vertex_wait;  // vertices: half of the shortest side of its triangles
  std::vector<int> corner_offsets, across;

 private:
  void find_neighbours(const IntrinsicTriangulation& T, const std::vector<char>& is_first);
  void find_sides(const IntrinsicTriangulation& T, const std::vector<char>& is_first);
  void find_corners(const IntrinsicTriangulation& T, const std::vector<char>& is_first);
  std::vector<RepeatedRow> find_copies(const IntrinsicTriangulation& T) const;
  void fetch_edges(std::size_t f) const;  // of triangle f, if there is one
  void find_bends(const std::vector<RepeatedRow>& copies);
};

}  // namespace littoral
