#include "littoral/domain/surface_mesh.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "littoral/base/error.h"

namespace littoral {

namespace {

/// Lists, for each of n keys, the items that carry it; items stay in order.
void bucket(const std::vector<int>& key_of_item, const std::vector<int>& value_of_item, int n,
            std::vector<int>& offsets, std::vector<int>& values) {
  offsets.assign(static_cast<std::size_t>(n) + 1, 0);
  for (int key : key_of_item) ++offsets[static_cast<std::size_t>(key) + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  values.resize(key_of_item.size());
  std::vector<int> next(offsets.begin(), offsets.end() - 1);
  for (std::size_t i = 0; i < key_of_item.size(); ++i)
    values[static_cast<std::size_t>(next[key_of_item[i]]++)] = value_of_item[i];
}

void check_faces(const PolygonSoup& soup) {
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto corners = soup.face(f);
    if (corners.size() < 3)
      throw InputError("face " + std::to_string(f) + " has " + std::to_string(corners.size()) +
                       " corners; a face needs three");
    for (int v : corners) {
      if (v < 0 || v >= soup.n_vertices())
        throw InputError("face " + std::to_string(f) + " refers to vertex " + std::to_string(v) +
                         ", there are " + std::to_string(soup.n_vertices()));
      if (!soup.points.row(v).allFinite())
        throw InputError("vertex " + std::to_string(v) + ", used by face " + std::to_string(f) +
                         ", has a coordinate that is not finite");
    }
  }
}

/// For each side (by its first corner) the first one with the same two ends.
std::vector<int> first_sides_by_ends(const PolygonSoup& soup) {
  const std::size_t n_corners = soup.corners.size();
  std::vector<int> tail(n_corners), head(n_corners);
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto corners = soup.face(f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::size_t c = static_cast<std::size_t>(soup.face_offsets[f]) + k;
      tail[c] = corners[k];
      head[c] = corners[(k + 1) % corners.size()];
    }
  }
  // Sides with the same smaller vertex are few: match them there.
  std::vector<int> low(n_corners), all(n_corners), offsets, by_low;
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t c = 0; c < n_corners; ++c) low[c] = std::min(tail[c], head[c]);
  bucket(low, all, soup.n_vertices(), offsets, by_low);
  std::vector<int> first_side(n_corners);
  for (int v = 0; v < soup.n_vertices(); ++v) {
    const auto begin = by_low.begin() + offsets[v], end = by_low.begin() + offsets[v + 1];
    std::stable_sort(begin, end, [&](int a, int b) {
      return std::max(tail[a], head[a]) < std::max(tail[b], head[b]);
    });
    for (auto it = begin; it != end; ++it) {
      const bool same = it != begin && std::max(tail[*it], head[*it]) ==
                                           std::max(tail[*(it - 1)], head[*(it - 1)]);
      first_side[*it] = same ? first_side[*(it - 1)] : *it;
    }
  }
  return first_side;
}

}  // namespace

void SurfaceMesh::check() {
  if (soup_.corners.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 2))
    throw InputError("the mesh has too many face corners for 32-bit numbering");
  check_faces(soup_);
}

SurfaceMesh::SurfaceMesh(PolygonSoup soup) : soup_(std::move(soup)) {
  check();
  connect(first_sides_by_ends(soup_));
  find_components();
}

SurfaceMesh::SurfaceMesh(PolygonSoup soup, const std::vector<int>& edge_of_side)
    : soup_(std::move(soup)) {
  check();
  std::vector<int> first_of(edge_of_side.size(), -1), first_side(edge_of_side.size());
  for (std::size_t c = 0; c < edge_of_side.size(); ++c) {
    int& first = first_of[edge_of_side[c]];
    if (first < 0) first = static_cast<int>(c);
    first_side[c] = first;
  }
  connect(first_side);
  find_components();
}

void SurfaceMesh::connect(const std::vector<int>& first_side) {
  const std::size_t n_corners = soup_.corners.size();
  std::vector<int> face_of(n_corners), first_ends;
  side_edge_.resize(n_corners);
  for (int f = 0; f < n_faces(); ++f) {
    const auto corners = face(f);
    triangles_ = triangles_ && corners.size() == 3;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::size_t c = static_cast<std::size_t>(soup_.face_offsets[f]) + k;
      face_of[c] = f;
      if (first_side[c] != static_cast<int>(c)) {
        side_edge_[c] = side_edge_[first_side[c]];
        continue;
      }
      side_edge_[c] = static_cast<int>(first_ends.size() / 2);
      first_ends.push_back(corners[k]);
      first_ends.push_back(corners[(k + 1) % corners.size()]);
    }
  }
  edges_ = Eigen::Map<const Rows<int, 2>>(first_ends.data(),
                                          static_cast<Eigen::Index>(first_ends.size() / 2), 2);
  bucket(side_edge_, face_of, n_edges(), edge_offsets_, edge_faces_);
  bucket(soup_.corners, face_of, n_vertices(), vertex_offsets_, vertex_faces_);
}

void SurfaceMesh::find_components() {
  const int n = n_vertices();
  vertex_component_.assign(n, -1);
  std::vector<int> stack;
  for (int seed = 0; seed < n; ++seed) {
    if (vertex_component_[seed] >= 0 || vertex_faces(seed).empty()) continue;
    vertex_component_[seed] = n_components_;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      for (int f : vertex_faces(v)) {
        for (int w : face(f)) {
          if (vertex_component_[w] >= 0) continue;
          vertex_component_[w] = n_components_;
          stack.push_back(w);
        }
      }
    }
    ++n_components_;
  }
}

Vec3 SurfaceMesh::position(const SurfacePoint& p) const {
  switch (p.on) {
    case SurfacePoint::On::vertex:
      return point(p.element);
    case SurfacePoint::On::edge:
      return p.b[0] * point(edges_(p.element, 0)) + p.b[1] * point(edges_(p.element, 1));
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
      if ((tail == a && head == b) || (tail == b && head == a))
        return side_edge(f, static_cast<int>(k));
    }
  }
  return -1;
}

}  // namespace littoral
