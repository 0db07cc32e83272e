#pragma once
// A triangle mesh without copies of faces: what lies there twice is there once.

#include <memory>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/sources.h"

namespace littoral {

/// The faces of a triangle mesh but for those with the same three edges as one before, whichever
/// way they are turned. Vertices and edges keep their numbers.
struct UniqueFaces {
  std::shared_ptr<const SurfaceMesh> mesh;  // the input itself if it has no copies, or polygons
  std::vector<int> face_of_input;  // of `mesh`; a copy's is that of the first. Empty: the same
  std::vector<int> input_face;     // of `mesh` -> of the input. Empty: the same

  explicit UniqueFaces(std::shared_ptr<const SurfaceMesh> input);

  bool any_copies() const { return !input_face.empty(); }
  int n_copies() const { return int(face_of_input.size() - input_face.size()); }
  /// Sources of the input on `mesh`; chains, of whole faces, keep their numbers, and so do elements
  /// that the input does not have.
  Sources on_mesh(const SurfaceMesh& input, Sources sources) const;
};

}  // namespace littoral
