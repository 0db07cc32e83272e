#pragma once
// Tetrahedra that fill a box, small near given points and large far from them.

#include <array>
#include <vector>

#include "littoral/tet_mesh.h"
#include "littoral/types.h"

namespace littoral {

/// A point of a tet mesh.
struct TetPoint {
  int tet = -1;  // -1: outside
  std::array<double, 4> barycentric{};
};

/// A field (vertices) at a point in a tet.
double interpolated(const TetMesh& mesh, const VecX& field, const TetPoint& p);

/// Cubes halved until those that hold a point are as small as asked for; neighbours across faces
/// and edges differ by one halving at most. Each cube is divided into tets about its centre, on a
/// triangulation of its faces that both sides derive from the same vertices: the tets conform,
/// though the cubes do not. Immutable.
class TetLattice {
 public:
  /// Fills the cube [origin, origin + side]^3; cubes with a point in or next to them have
  /// 2^-depth of the side (1 <= depth <= 16). Points outside are left out. Throws InputError if
  /// more than 2^26 tets are needed.
  TetLattice(const Vec3& origin, double side, int depth, const MatX3& points);

  const TetMesh& mesh() const { return mesh_; }
  double finest() const;  // side of the smallest cubes
  int n_cubes() const { return first_tet_.size() - 1; }

  /// The tet that holds x; x outside the cube gives tet -1.
  TetPoint locate(const Vec3& x) const;
  /// The cube that holds the tet.
  int cube_of(int tet) const { return cube_[tet]; }

 private:
  Vec3 origin_;
  double side_;
  int depth_;
  TetMesh mesh_;
  std::vector<int> child_;      // octree node -> the first of its eight children, or -1 - cube
  std::vector<int> first_tet_;  // per cube, and the end
  std::vector<int> cube_;       // per tet
};

}  // namespace littoral
