#pragma once
// The calculus of tet meshes: Crouzeix-Raviart functions on faces for diffusion (Appendix B),
// linear functions on vertices for distance.

#include <memory>
#include <vector>

#include "littoral/tet_mesh.h"
#include "littoral/types.h"
#include "operators/calculus.h"

namespace littoral {

/// Operators of one tet mesh. Symmetric matrices store their lower triangle only.
struct TetOperators {
  // Crouzeix-Raviart: one function per face, 1 on it and -2 at the opposite corner of its tets.
  int n_faces = 0;
  Rows<int, 4> tet_faces;  // tets x 4; face k is opposite corner k
  SpMat face_mass;         // faces x faces [length^3], eq. 23
  SpMat face_laplacian;    // faces x faces [length], positive semidefinite, eq. 21

  // Linear functions on vertices.
  SpMat L;       // vertices x vertices [length], positive semidefinite
  VecX volumes;  // tets [length^3]
  std::vector<Eigen::Matrix<double, 4, 3>> gradients;  // tets: of the corners' functions
  std::vector<int> component;  // vertices; -1 for those in no tet of any volume
  int n_components = 0;

  /// G^T A Y for Y constant on tets (tets x 3): the integral of grad lambda_i . Y (eq. 22, where a
  /// factor -1/3 is missing). Vertices.
  VecX divergence(const MatX3& Y) const;
  /// Gradient on tets of a function linear on each (tets x 3).
  MatX3 gradient(const VecX& u) const;
  /// Lumped mass (vertices) [length^3]: a quarter of each tet's volume at each of its corners.
  VecX vertex_mass() const;
  /// Mean over the four faces of a tet (B.2): faces x 3 -> tets x 3.
  MatX3 to_tets(const MatX3& X) const;

  const Rows<int, 4>& tets() const { return tets_; }

 private:
  friend TetOperators tet_operators(const TetMesh& mesh);
  Rows<int, 4> tets_;
};

/// Flat tets count as nothing. Orientation does not matter. Throws InputError for an index out of
/// range, a vertex of a tet that is not finite, and a mesh without volume.
TetOperators tet_operators(const TetMesh& mesh);

/// Linear functions on the vertices as a calculus, for methods that know no tets: cells are tets
/// with three numbers each, M [length^3] is lumped, h the mean edge of regular tets of these
/// volumes.
Calculus tet_calculus(const std::shared_ptr<const TetOperators>& T);

}  // namespace littoral
