#include "methods/geodesic/exact_polyhedral_pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "base/same_rows.h"

namespace littoral {

namespace {

constexpr std::size_t vertex_grain = 4096, triangle_grain = 16384;

/// Triangles but for those with the same three edges as one before.
std::vector<char> first_of_its_edges(const IntrinsicTriangulation& T) {
  std::vector<int> shared;  // only where all three edges have a second triangle can there be a copy
  for (int f = 0; f < T.n_faces(); ++f)
    if (T.edge_use[T.side_edge(f, 0)] > 1 && T.edge_use[T.side_edge(f, 1)] > 1 &&
        T.edge_use[T.side_edge(f, 2)] > 1)
      shared.push_back(f);
  std::vector<char> is_first(std::size_t(T.n_faces()), 1);
  for (const RepeatedRow& copy : repeated_rows(T.side_edge.matrix(), shared))
    is_first[copy.row] = 0;
  return is_first;
}

/// Whether the triangles around a vertex close up to a cone. `first_side` starts at v.
bool walk_closes_up(const IntrinsicTriangulation& T, const PolyhedralPages& P, int v,
                    int first_side, int n_corners) {
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

/// The same from the two edges at v of each of the corners, read all at once: a walk would wait for
/// one triangle after the other.
bool closes_up(const IntrinsicTriangulation& T, const PolyhedralPages& P, int v) {
  constexpr std::size_t most = 16;
  const auto corners = P.around(v);
  const std::size_t n = corners.size();
  const auto walk = [&] {
    const int side = corners.front();
    return walk_closes_up(T, P, v, side - side % 3 + (side + 2) % 3, static_cast<int>(n));
  };
  if (n > most) return walk();
  std::array<std::array<int, 2>, most> ends;
  for (std::size_t i = 0; i < n; ++i) {
    const int f = corners[i] / 3, across = corners[i] % 3;
    ends[i] = {T.side_edge(f, (across + 1) % 3), T.side_edge(f, (across + 2) % 3)};
  }
  std::size_t at = 0, passed = 0;
  int through = ends[0][1];
  do {
    std::size_t next = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == at || (ends[i][0] != through && ends[i][1] != through)) continue;
      if (next < n) return walk();  // an edge with both ends at v
      next = i;
    }
    if (next == n) return walk();  // a triangle glued to itself
    through = ends[next][ends[next][0] == through ? 1 : 0];
    at = next;
  } while (++passed < n && at != 0);
  return passed == n && at == 0;
}

double wait_in(const IntrinsicTriangulation& T, int f) { return 0.5 * T.length.row(f).minCoeff(); }

}  // namespace

/// Angles added up as a product of rotations: arc tangents would take longer than all the rest.
struct PolyhedralPages::Turn {
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
  bool more_than_full() const {
    return full > 1 || (full == 1 && !(x > 0 && y >= 0 && y <= 1e-12 * x));
  }
};

PolyhedralPages::PolyhedralPages(const IntrinsicTriangulation& T)
    : triangles(T.n_faces()),
      edges(T.n_edges()),
      bends(T.n_vertices, never),
      vertex_wait(T.n_vertices, std::numeric_limits<float>::infinity()),
      corner_offsets(T.n_vertices + 1, 0) {
  const std::vector<char> is_first = first_of_its_edges(T);
  std::vector<Turn> turn(std::size_t(T.n_vertices));
  parallel_for(2, 1, [&](std::size_t half, std::size_t) {  // neither needs anything of the other
    if (half == 0)
      find_sides(T, is_first);
    else
      find_corners(T, is_first, turn);
  });
  parallel_for(triangles.size(), triangle_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        triangles[f].length[k] = T.length(f, k);
        triangles[f].vertex[k] = T.faces(f, k);
        triangles[f].edge[k] = T.side_edge(f, k);
        triangles[f].along[k] = T.along(f, k);
      }
  });
  for (int e = 0; e < T.n_edges(); ++e)
    if (edges[e].n_pages() != 2) bends[T.edges(e, 0)] = bends[T.edges(e, 1)] = anywhere;
  // Where triangles disagree about an edge, a bent path can be shorter by that than the straight
  // one which it cuts off.
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      if (T.length(f, k) > edges[T.side_edge(f, k)].length)
        for (int c = 0; c < 3; ++c) bends[T.faces(f, c)] = anywhere;
  parallel_for(bends.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (bends[v] == never && !around(int(v)).empty())
        bends[v] = !closes_up(T, *this, int(v)) ? anywhere
                   : turn[v].more_than_full()   ? behind
                                                : never;
  });
}

void PolyhedralPages::find_sides(const IntrinsicTriangulation& T,
                                 const std::vector<char>& is_first) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int e = 0; e < T.n_edges(); ++e)
    edges[e] = {infinity, infinity, T.edges(e, 0), T.edges(e, 1), {-1, -1}};
  std::vector<int> more;  // at edges with two already
  for (int f = 0; f < T.n_faces(); ++f) {
    const double wait = wait_in(T, f);
    for (int k = 0; k < 3; ++k) {
      Edge& edge = edges[T.side_edge(f, k)];
      edge.length = std::min(edge.length, T.length(f, k));
      edge.wait = std::min(edge.wait, wait);
      if (!is_first[f]) continue;
      const int side = 3 * f + k;
      if (edge.sides[0] < 0)
        edge.sides[0] = side;
      else if (edge.sides[1] < 0)
        edge.sides[1] = side;
      else
        more.push_back(side);
    }
  }
  const auto edge_of = [&](int side) { return T.side_edge(side / 3, side % 3); };
  std::stable_sort(more.begin(), more.end(), [&](int a, int b) { return edge_of(a) < edge_of(b); });
  for (std::size_t i = 0; i < more.size();) {
    const int e = edge_of(more[i]), first = int(pages.size());
    pages.insert(pages.end(), edges[e].sides.begin(), edges[e].sides.end());
    while (i < more.size() && edge_of(more[i]) == e) pages.push_back(more[i++]);
    edges[e].sides = {first, first - int(pages.size())};
  }
}

void PolyhedralPages::find_corners(const IntrinsicTriangulation& T,
                                   const std::vector<char>& is_first, std::vector<Turn>& turn) {
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) corner_offsets[T.faces(f, k) + 1] += is_first[f];
  std::partial_sum(corner_offsets.begin(), corner_offsets.end(), corner_offsets.begin());
  across.resize(corner_offsets.back());
  std::vector<int> next_corner(corner_offsets.begin(), corner_offsets.end() - 1);
  for (int f = 0; f < T.n_faces(); ++f) {
    if (!is_first[f]) continue;
    const TriangleShape shape = T.shape(f);
    const auto wait = float(wait_in(T, f));
    for (int k = 0; k < 3; ++k) {
      float& least = vertex_wait[T.faces(f, k)];
      least = std::min(least, wait);
      across[next_corner[T.faces(f, k)]++] = 3 * f + (k + 1) % 3;
      turn[T.faces(f, k)].add(shape.cot[k]);
    }
  }
}

}  // namespace littoral
