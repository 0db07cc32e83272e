#pragma once
// Which triangle of a triangulation a face of its mesh is.

#include <utility>
#include <vector>

namespace littoral {

/// Triangles of the faces of a mesh, -1 for a face that has none. Where every face f is triangle f,
/// as nearly always, there is no list of them.
class FaceTriangles {
 public:
  FaceTriangles() = default;
  /// Every face is the triangle of its number.
  explicit FaceTriangles(int n_faces) : n_(n_faces) {}
  explicit FaceTriangles(std::vector<int> triangle_of_face)
      : n_(static_cast<int>(triangle_of_face.size())), listed_(std::move(triangle_of_face)) {}

  int size() const { return n_; }
  int operator[](int f) const { return listed_.empty() ? f : listed_[f]; }

 private:
  int n_ = 0;
  std::vector<int> listed_;
};

}  // namespace littoral
