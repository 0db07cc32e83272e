#include "api/surface/surface_domain.h"

namespace littoral {

std::string SurfaceDomain::kind() const {
  if (face_normals) return "voxel surface";
  if (mesh->n_faces() == 0) return "point cloud";
  return mesh->is_triangle_mesh() ? "triangle mesh" : "polygon mesh";
}

SurfaceDomain domain_of(const SurfaceMesh& mesh, const MatX3* face_normals) {
  if (face_normals && face_normals->rows() != mesh.n_faces())
    throw InputError("there are " + std::to_string(face_normals->rows()) + " normals for " +
                         std::to_string(mesh.n_faces()) + " faces",
                     "sizes-differ");
  const auto borrowed = [](const auto* object) {
    return std::shared_ptr<std::remove_pointer_t<decltype(object)>>(object, [](const auto*) {});
  };
  return {borrowed(&mesh), face_normals ? borrowed(face_normals) : nullptr};
}

}  // namespace littoral
