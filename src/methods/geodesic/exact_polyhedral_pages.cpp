#include "methods/geodesic/exact_polyhedral_pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr int fetched_ahead = 12;  // what is read here and there, by this many
constexpr std::size_t vertex_grain = 4096, edge_grain = 16384, triangle_grain = 8192;

/// Whether the triangles around a vertex close up to a cone. `first_side` starts at v.
bool walk_closes_up(const PolyhedralPages& P, int v, int first_side, int n_corners) {
  int side = first_side, n = 0;
  do {
    const int f = side / 3, k = side % 3;
    const bool starts = P.triangles[f].vertex[k] == v;
    const int leave = starts ? (k + 2) % 3 : (k + 1) % 3;
    const auto at = P.at(P.triangles[f].edge[leave]);
    side = at[0] == 3 * f + leave ? at[1] : at[0];
  } while (++n < n_corners && side / 3 != first_side / 3);
  return n == n_corners && side / 3 == first_side / 3;
}

/// The same from the two edges at v of each of the corners, read all at once: a walk would wait for
/// one triangle after the other.
bool closes_up(const PolyhedralPages& P, int v) {
  constexpr std::size_t most = 16;
  const auto corners = P.around(v);
  const std::size_t n = corners.size();
  const auto walk = [&] {
    const int side = corners.front();
    return walk_closes_up(P, v, side - side % 3 + (side + 2) % 3, static_cast<int>(n));
  };
  if (n > most) return walk();
  std::array<std::array<int, 2>, most> ends;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& edge = P.triangles[corners[i] / 3].edge;
    const int across = corners[i] % 3;
    ends[i] = {edge[(across + 1) % 3], edge[(across + 2) % 3]};
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

double wait_in(const PolyhedralPages::Triangle& t) {
  return 0.5 * std::min(std::min(t.length[0], t.length[1]), t.length[2]);
}

/// Angles added up as a product of rotations: arc tangents would take longer than all the rest.
struct Turn {
  double x = 1, y = 0;  // some multiple of the rotation
  int full = 0;         // turns

  /// An angle below half a turn, by any multiple of its cosine and sine.
  void add(double cos, double sin) {
    constexpr double large = 1e100;
    const bool low = y < 0;
    const double next_x = x * cos - y * sin, next_y = y * cos + x * sin;
    const double size = std::max(std::abs(next_x), std::abs(next_y));
    const double by = size > large || (size < 1 / large && size > 0) ? 1 / size : 1;
    x = next_x * by;
    y = next_y * by;
    full += low && y >= 0;
  }
  bool more_than_full() const {
    return full > 1 || (full == 1 && !(x > 0 && y >= 0 && y <= 1e-12 * x));
  }
};

/// What a triangle's sides and its corners have to know of it.
enum Trouble : unsigned char {
  first_side = 1,  // side k, first_side << k, does not lie between exactly two triangles
  disagrees = 8,   // longer at an edge than another triangle
};

}  // namespace

PolyhedralPages::PolyhedralPages(const IntrinsicTriangulation& T)
    : triangles(T.n_faces()),
      edges(T.n_edges()),
      bends(T.n_vertices),
      vertex_wait(T.n_vertices),
      corner_offsets(T.n_vertices + 1) {
  parallel_for(triangles.size(), triangle_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        triangles[f].length[k] = T.length(f, k);
        triangles[f].vertex[k] = T.faces(f, k);
        triangles[f].edge[k] = T.side_edge(f, k);
        triangles[f].along[k] = T.along(f, k);
      }
  });
  find_neighbours(T, std::vector<char>(triangles.size(), 1));
  const std::vector<RepeatedRow> copies = find_copies(T);
  if (!copies.empty()) {
    std::vector<char> is_first(triangles.size(), 1);
    for (const RepeatedRow& copy : copies) is_first[copy.row] = 0;
    find_neighbours(T, is_first);
  }
  find_bends(copies);
}

void PolyhedralPages::find_neighbours(const IntrinsicTriangulation& T,
                                      const std::vector<char>& is_first) {
  parallel_for(edges.size(), edge_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      edges[e] = {infinity, infinity, T.edges(index(e), 0), T.edges(index(e), 1), {-1, -1}};
  });
  parallel_for(2, 1, [&](std::size_t half, std::size_t) {  // neither needs anything of the other
    if (half == 0)
      find_sides(T, is_first);
    else
      find_corners(T, is_first);
  });
}

void PolyhedralPages::find_sides(const IntrinsicTriangulation& T,
                                 const std::vector<char>& is_first) {
  std::vector<int> more;  // at edges with two already
  for (int f = 0; f < T.n_faces(); ++f) {
    fetch_edges(f + fetched_ahead);
    const double wait = wait_in(triangles[f]);
    for (int k = 0; k < 3; ++k) {
      Edge& edge = edges[triangles[f].edge[k]];
      edge.length = std::min(edge.length, triangles[f].length[k]);
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
  pages.clear();
  for (std::size_t i = 0; i < more.size();) {
    const int e = edge_of(more[i]), first = int(pages.size());
    pages.insert(pages.end(), edges[e].sides.begin(), edges[e].sides.end());
    while (i < more.size() && edge_of(more[i]) == e) pages.push_back(more[i++]);
    edges[e].sides = {first, first - int(pages.size())};
  }
}

void PolyhedralPages::fetch_edges(std::size_t f) const {
  if (f < triangles.size())
    for (const int e : triangles[f].edge) fetch_ahead(&edges[e]);
}

void PolyhedralPages::find_corners(const IntrinsicTriangulation& T,
                                   const std::vector<char>& is_first) {
  std::fill(corner_offsets.begin(), corner_offsets.end(), 0);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) corner_offsets[T.faces(f, k) + 1] += is_first[f];
  std::partial_sum(corner_offsets.begin(), corner_offsets.end(), corner_offsets.begin());
  across.resize(corner_offsets.back());
  std::vector<int> next_corner(corner_offsets.begin(), corner_offsets.end() - 1);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      if (is_first[f]) across[next_corner[T.faces(f, k)]++] = 3 * f + (k + 1) % 3;
}

std::vector<RepeatedRow> PolyhedralPages::find_copies(const IntrinsicTriangulation& T) const {
  return repeated_faces(T.side_edge.matrix(), [&](int f) {
    const auto sides = at(edges[T.side_edge(f, 0)]);
    return sides.size() > 2    ? several_faces
           : sides.size() < 2  ? no_face
           : sides[0] / 3 == f ? sides[1] / 3
                               : sides[0] / 3;
  });
}

void PolyhedralPages::find_bends(const std::vector<RepeatedRow>& copies) {
  std::vector<unsigned char> trouble(triangles.size(), 0);
  parallel_for(triangles.size(), triangle_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      fetch_edges(f + fetched_ahead);
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge& edge = edges[triangles[f].edge[k]];
        if (edge.n_pages() != 2) trouble[f] |= first_side << k;
        // Where triangles disagree about an edge, a bent path can be shorter by that than the
        // straight one which it cuts off.
        if (triangles[f].length[k] > edge.length) trouble[f] |= disagrees;
      }
    }
  });
  for (const RepeatedRow& copy : copies) trouble[copy.first] |= trouble[copy.row] & disagrees;
  parallel_for(bends.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Turn turn;
      float wait = std::numeric_limits<float>::infinity();
      bool bent = false;
      for (int i = corner_offsets[v]; i < corner_offsets[v + 1]; ++i) {
        if (std::size_t(i) + fetched_ahead < across.size())
          fetch_ahead(&triangles[across[i + fetched_ahead] / 3]);
        const int f = across[i] / 3, side = across[i] % 3;
        const Triangle& t = triangles[f];
        wait = std::min(wait, float(wait_in(t)));
        const int at_corner = first_side << (side + 1) % 3 | first_side << (side + 2) % 3;
        bent = bent || (trouble[f] & (at_corner | disagrees)) != 0;
        turn.add(law_of_cosines(t.length[(side + 1) % 3], t.length[(side + 2) % 3], t.length[side]),
                 4 * area_of_lengths(t.length[0], t.length[1], t.length[2]));
      }
      vertex_wait[v] = wait;
      bends[v] = bent                        ? anywhere
                 : around(int(v)).empty()    ? never
                 : !closes_up(*this, int(v)) ? anywhere
                 : turn.more_than_full()     ? behind
                                             : never;
    }
  });
}

}  // namespace littoral
