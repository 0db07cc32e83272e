#include "domain/mesh/vertex_faces.h"

#include <algorithm>
#include <cstddef>

namespace littoral {

namespace {

constexpr std::size_t most_walks = 4;

std::vector<int> faces_by_a_walk(const PolygonSoup& soup, int v) {
  std::vector<int> faces;
  const auto begin = soup.corners.begin(), end = soup.corners.end();
  for (auto at = std::find(begin, end, v); at != end; at = std::find(at + 1, end, v)) {
    const auto after =
        std::upper_bound(soup.face_offsets.begin(), soup.face_offsets.end(), at - begin);
    faces.push_back(static_cast<int>(after - soup.face_offsets.begin()) - 1);
  }
  return faces;
}

}  // namespace

std::span<const int> VertexFaces::at(int v) const {
  if (has_all_.load(std::memory_order_acquire)) return all_.at(v);
  const std::lock_guard lock(mutex_);
  if (has_all_.load(std::memory_order_relaxed)) return all_.at(v);
  if (const auto known = few_.find(v); known != few_.end()) return known->second;
  if (few_.size() < most_walks) return few_.emplace(v, faces_by_a_walk(soup_, v)).first->second;
  all_ = groups_of<int>(std::size_t(soup_.n_vertices()), [&](const auto& put) {
    for (int f = 0; f < soup_.n_faces(); ++f)
      for (const int corner : soup_.face(f)) put(corner, f);
  });
  has_all_.store(true, std::memory_order_release);
  return all_.at(v);
}

}  // namespace littoral
