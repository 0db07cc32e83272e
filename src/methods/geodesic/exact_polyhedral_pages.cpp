#include "methods/geodesic/exact_polyhedral_pages.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/same_rows.h"

namespace littoral {

namespace {

/// Triangles but for those with the same three edges as one before.
std::vector<char> first_of_its_edges(const IntrinsicTriangulation& T) {
  std::vector<int> shared;  // only where all three edges have a second triangle can there be a copy
  for (int f = 0; f < T.n_faces(); ++f)
    if (T.edge_use[T.side_edge(f, 0)] > 1 && T.edge_use[T.side_edge(f, 1)] > 1 &&
        T.edge_use[T.side_edge(f, 2)] > 1)
      shared.push_back(f);
  std::vector<char> is_first(std::size_t(T.n_faces()), 1);
  for (const RepeatedRow& copy : repeated_rows(T.side_edge, shared)) is_first[copy.row] = 0;
  return is_first;
}

/// Whether the triangles around a vertex, from side `enter` of triangle f on, close up to a cone.
bool closes_up(const IntrinsicTriangulation& T, const PolyhedralPages& P, int v, int first_side,
               int n_corners) {
  // `first_side` starts at v.
  int side = first_side, n = 0;
  do {
    const int f = side / 3, k = side % 3;
    const bool starts = T.faces(f, k) == v;
    const int leave = starts ? (k + 2) % 3 : (k + 1) % 3;
    const auto at = P.at(T.side_edge(f, leave));
    side = at[0] == 3 * f + leave ? at[1] : at[0];
  } while (++n < n_corners && side / 3 != first_side / 3);
  return n == n_corners && side / 3 == first_side / 3;
}

/// Angles added up as a product of rotations: arc tangents would take longer than all the rest.
struct Turn {
  double x = 1, y = 0;  // some multiple of the rotation
  int full = 0;         // turns

  void add(double cot) {  // an angle below half a turn
    const bool low = y < 0;
    const double next_x = x * cot - y, next_y = y * cot + x;
    const double size = std::max(std::abs(next_x), std::abs(next_y));
    x = next_x / size;
    y = next_y / size;
    full += low && y >= 0;
  }
  bool more_than_full() const { return full > 1 || (full == 1 && !(x > 0 && y <= 1e-12 * x)); }
};

}  // namespace

PolyhedralPages::PolyhedralPages(const IntrinsicTriangulation& T)
    : edges(T.n_edges()), bends(T.n_vertices, never), corner_offsets(T.n_vertices + 1, 0) {
  for (int e = 0; e < T.n_edges(); ++e)
    edges[e] = {infinity, infinity, T.edges(e, 0), T.edges(e, 1), 0, 0};
  const std::vector<char> is_first = first_of_its_edges(T);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      Edge& edge = edges[T.side_edge(f, k)];
      edge.length = std::min(edge.length, T.length(f, k));
      edge.wait = std::min(edge.wait, 0.5 * T.length.row(f).minCoeff());
      edge.n_pages += is_first[f];
      corner_offsets[T.faces(f, k) + 1] += is_first[f];
    }
  int n_pages = 0;
  for (Edge& edge : edges) {
    edge.first_page = n_pages;
    n_pages += std::exchange(edge.n_pages, 0);
  }
  std::partial_sum(corner_offsets.begin(), corner_offsets.end(), corner_offsets.begin());
  pages.resize(n_pages);
  across.resize(n_pages);
  std::vector<int> next_corner(corner_offsets.begin(), corner_offsets.end() - 1);
  std::vector<Turn> turn(std::size_t(T.n_vertices));
  for (int f = 0; f < T.n_faces(); ++f) {
    if (!is_first[f]) continue;
    const TriangleShape shape = T.shape(f);
    for (int k = 0; k < 3; ++k) {
      Edge& edge = edges[T.side_edge(f, k)];
      pages[edge.first_page + edge.n_pages++] = 3 * f + k;
      across[next_corner[T.faces(f, k)]++] = 3 * f + (k + 1) % 3;
      turn[T.faces(f, k)].add(shape.cot[k]);
    }
  }
  for (int e = 0; e < T.n_edges(); ++e)
    if (edges[e].n_pages != 2) bends[T.edges(e, 0)] = bends[T.edges(e, 1)] = anywhere;
  // Where triangles disagree about an edge, a bent path can be shorter by that than the straight
  // one which it cuts off.
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      if (T.length(f, k) > edges[T.side_edge(f, k)].length)
        for (int c = 0; c < 3; ++c) bends[T.faces(f, c)] = anywhere;
  for (int v = 0; v < T.n_vertices; ++v) {
    const auto corners = around(v);
    if (bends[v] || corners.empty()) continue;
    const int side = corners.front(), f = side / 3;
    const bool more = turn[v].more_than_full();
    if (!closes_up(T, *this, v, 3 * f + (side + 2) % 3, static_cast<int>(corners.size())))
      bends[v] = anywhere;
    else if (more)
      bends[v] = behind;
  }
}

}  // namespace littoral
