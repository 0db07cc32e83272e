#pragma once
// Faces at the vertices of a mesh, found when they are asked for.

#include <atomic>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "base/groups.h"
#include "littoral/polygon_soup.h"

namespace littoral {

/// Faces at the vertices of a soup that outlives this and stays as it is; several threads may ask.
///
/// Most of what is done with a mesh needs none of them, or those at a source or two: these are
/// found by a walk over all faces. From the fifth vertex on there is a table for all vertices.
class VertexFaces {
 public:
  explicit VertexFaces(const PolygonSoup& soup) : soup_(soup) {}
  VertexFaces(const VertexFaces&) = delete;
  VertexFaces& operator=(const VertexFaces&) = delete;

  /// Ascending; a face is listed once for each of its corners at the vertex.
  std::span<const int> at(int v) const;

 private:
  const PolygonSoup& soup_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::vector<int>> few_;
  mutable std::atomic<bool> has_all_{false};
  mutable Groups<int> all_;
};

}  // namespace littoral
