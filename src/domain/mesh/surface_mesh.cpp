#include "domain/mesh/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/counted.h"
#include "base/disjoint_sets.h"
#include "base/fetch_ahead.h"
#include "base/large_vector.h"
#include "base/parallel.h"
#include "base/parallel_sum.h"
#include "domain/mesh/face_orientation.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr std::size_t vertex_grain = 8192, corner_face_grain = 16384;

/// Returns its largest coordinate.
double check_face(const PolygonSoup& soup, int f) {
  const auto corners = soup.face(f);
  if (corners.size() < 3)
    throw InputError("face " + std::to_string(f) + " has " +
                     counted(corners.size(), "corner", "corners") +
                     "; a face needs three at least");
  double largest = 0;
  for (int v : corners) {
    if (v < 0 || v >= soup.n_vertices())
      throw InputError("face " + std::to_string(f) + " refers to vertex " + std::to_string(v) +
                           "; the mesh has " + counted(soup.n_vertices(), "vertex", "vertices") +
                           ", counted from 0",
                       "no-such-element");
    // By number: the functions of a row of Eigen's are calls, two for every corner.
    const double x = soup.points(v, 0), y = soup.points(v, 1), z = soup.points(v, 2);
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
      throw InputError("vertex " + std::to_string(v) + ", used by face " + std::to_string(f) +
                           ", has a coordinate that is not finite",
                       "not-finite");
    largest = std::max({largest, std::abs(x), std::abs(y), std::abs(z)});
  }
  return largest;
}

/// Returns the largest coordinate of a face.
double check_faces(const PolygonSoup& soup) {
  const std::size_t n = std::size_t(soup.n_faces());
  const auto largest = [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t ahead = 16;  // corners: points are read in any order
    double here = 0;
    for (std::size_t f = begin; f < end; ++f) {
      const std::size_t next = std::size_t(soup.face_offsets[f]) + ahead;
      for (std::size_t c = next; c < std::min(next + 3, soup.corners.size()); ++c)
        if (const int v = soup.corners[c]; v >= 0 && v < soup.n_vertices())
          fetch_ahead(&soup.points(v, 0));
      here = std::max(here, check_face(soup, int(f)));
    }
    return here;
  };
  return of_pieces(n, corner_face_grain, 0.0, largest, Larger());
}

/// For each side (by its first corner) the first one with the same two ends.
LargeVector<int> first_sides_by_ends(const PolygonSoup& soup) {
  using Side = std::uint64_t;  // the larger vertex, then the side: ascending as sides are given
  const std::size_t n = std::size_t(soup.n_vertices());
  // Sides with the same smaller vertex are few: match them there.
  const auto for_sides = [&](std::size_t from, std::size_t to, const auto& visit) {
    for (int f = 0; f < soup.n_faces(); ++f) {
      const auto corners = soup.face(f);
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const int tail = corners[k], head = corners[k + 1 < corners.size() ? k + 1 : 0];
        const auto low = std::size_t(std::min(tail, head));
        if (low >= from && low < to) visit(low, std::max(tail, head), soup.face_offsets[f] + k);
      }
    }
  };
  std::vector<int> begin(n + 1, 0);
  LargeVector<int> first_side(soup.corners.size());
  LargeVector<Side> by_low(soup.corners.size());
  parallel_ranges(n, vertex_grain, [&](std::size_t from, std::size_t to) {
    for_sides(from, to, [&](std::size_t low, int, std::size_t) { ++begin[low]; });
  });
  int sum = 0;
  for (int& b : begin) sum += std::exchange(b, sum);
  parallel_ranges(n, vertex_grain, [&](std::size_t from, std::size_t to) {
    auto at = by_low.begin() + begin[from];
    for_sides(from, to, [&](std::size_t low, int high, std::size_t side) {
      by_low[begin[low]++] = Side(high) << 32 | side;  // begin becomes the end of each
    });
    for (std::size_t v = from; v < to; ++v) {
      const auto first = at, end = by_low.begin() + begin[v];
      std::sort(first, end);
      for (; at != end; ++at) {
        const bool same = at != first && (*at >> 32) == (*(at - 1) >> 32);
        const auto side = std::uint32_t(*at);
        first_side[side] = same ? first_side[std::uint32_t(*(at - 1))] : int(side);
      }
    }
  });
  return first_side;
}

}  // namespace

SurfaceMesh::Parts::Parts(PolygonSoup of) : soup(std::move(of)) {
  if (soup.corners.size() > std::numeric_limits<int>::max() / 2)
    throw InputError(
        "the mesh has more than 2147483647 face corners; simplify it or take a part of it",
        "too-large");
  const double largest = check_faces(soup);
  triangles = soup.corners.size() == 3 * std::size_t(soup.n_faces());  // none has fewer than three
  if (largest > 0) scale = std::ldexp(1.0, std::ilogb(largest));
}

SurfaceMesh::SurfaceMesh(PolygonSoup soup) {
  const auto parts = std::make_shared<Parts>(std::move(soup));
  parts->connect(first_sides_by_ends(parts->soup));
  parts_ = parts;
}

SurfaceMesh::SurfaceMesh(PolygonSoup soup, const std::vector<int>& edge_of_side) {
  const auto parts = std::make_shared<Parts>(std::move(soup));
  // Numbers of edges that no side has are left out, so there may be more edges than sides.
  const int most = edge_of_side.empty() ? -1 : *std::ranges::max_element(edge_of_side);
  std::vector<int> first_of(std::size_t(most + 1), -1), first_side(edge_of_side.size());
  for (std::size_t c = 0; c < edge_of_side.size(); ++c) {
    int& first = first_of[edge_of_side[c]];
    if (first < 0) first = c;
    first_side[c] = first;
  }
  parts->connect(first_side);
  parts_ = parts;
}

void SurfaceMesh::Parts::connect(std::span<const int> first_side) {
  number_edges(first_side);
  parallel_for(2, 1, [&](std::size_t half, std::size_t) {  // neither needs anything of the other
    if (half == 0)
      find_edge_faces();
    else
      find_components();
  });
}

void SurfaceMesh::Parts::number_edges(std::span<const int> first_side) {
  const auto n = std::size_t(soup.n_faces());
  const auto for_corners = [&](const auto& body) {  // body(piece, begin, end)
    parallel_for(n, corner_face_grain, [&](std::size_t begin, std::size_t end) {
      body(begin / corner_face_grain, soup.face_offsets[begin], soup.face_offsets[end]);
    });
  };
  std::vector<int> next((n + corner_face_grain - 1) / corner_face_grain);  // edge, of each piece
  for_corners([&](std::size_t piece, int begin, int end) {
    int firsts = 0;
    for (int c = begin; c < end; ++c) firsts += first_side[c] == c;
    next[piece] = firsts;
  });
  int sum = 0;
  for (int& number : next) sum += std::exchange(number, sum);
  edges.resize(sum, 2);
  side_edge.resize(soup.corners.size());
  parallel_for(n, corner_face_grain, [&](std::size_t begin, std::size_t end) {
    int number = next[begin / corner_face_grain];
    for (std::size_t f = begin; f < end; ++f) {
      const auto corners = soup.face(int(f));
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto c = int(soup.face_offsets[f] + k);
        if (first_side[c] != c) continue;
        side_edge[c] = number;
        edges.row(number++) << corners[k], corners[(k + 1) % corners.size()];
      }
    }
  });
  for_corners([&](std::size_t, int begin, int end) {
    for (int c = begin; c < end; ++c)
      if (first_side[c] != c) side_edge[c] = side_edge[first_side[c]];
  });
}

void SurfaceMesh::Parts::find_edge_faces() {
  edge_faces = groups_of<int>(std::size_t(edges.rows()), [&](const auto& put) {
    for (int f = 0; f < soup.n_faces(); ++f)
      for (int c = soup.face_offsets[f]; c < soup.face_offsets[f + 1]; ++c) put(side_edge[c], f);
  });
}

void SurfaceMesh::Parts::find_components() {
  DisjointSets sets(soup.n_vertices());
  std::vector<char> used(soup.n_vertices(), 0);
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto corners = soup.face(f);
    for (const int v : corners) {
      used[v] = 1;
      sets.join(corners[0], v);
    }
  }
  vertex_component = sets.numbered(n_components, used);
}

SharedRows<int, 2> SurfaceMesh::shared_edges() const {
  return {{parts_, parts_->edges.data()}, parts_->edges.rows()};
}

SharedRows<int, 3> SurfaceMesh::shared_faces() const {
  return {{parts_, soup().corners.data()}, n_faces()};
}

SharedRows<int, 3> SurfaceMesh::shared_side_edges() const {
  return {{parts_, parts_->side_edge.data()}, n_faces()};
}

Vec3 SurfaceMesh::position(const SurfacePoint& p) const {
  switch (p.on) {
    case SurfacePoint::On::vertex:
      return point(p.element);
    case SurfacePoint::On::edge:
      return p.b[0] * point(edges()(p.element, 0)) + p.b[1] * point(edges()(p.element, 1));
    case SurfacePoint::On::face:
      break;
  }
  const auto corners = face(p.element);
  return p.b[0] * point(corners[0]) + p.b[1] * point(corners[1]) + p.b[2] * point(corners[2]);
}

int SurfaceMesh::find_edge(int a, int b) const {
  for (int f : vertex_faces(a)) {
    const auto corners = face(f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int tail = corners[k], head = corners[(k + 1) % corners.size()];
      if ((tail == a && head == b) || (tail == b && head == a)) return side_edge(f, k);
    }
  }
  return -1;
}

}  // namespace littoral
