#pragma once
// Straight lines within a tet mesh.

#include <limits>
#include <span>
#include <vector>

#include "littoral/tet_mesh.h"

namespace littoral {

/// Whether one point sees another: lines go from tet to tet across the faces that these share, so
/// what lies side by side without being joined does not see each other. Keeps references to what it
/// is made from. Immutable; each thread brings a Walk of its own.
class TetSight {
 public:
  using Gradients = std::vector<Eigen::Matrix<double, 4, 3>>;

  /// tet_faces: tets x 4, numbers of the faces opposite the corners; gradients: of the barycentric
  /// coordinates, zero in flat tets, through which everything passes.
  TetSight(const TetMesh& mesh, const Rows<int, 4>& tet_faces, int n_faces,
           const Gradients& gradients);

  struct Part {
    int tet;
    double low, high;  // of the line, 0 to 1
  };
  /// Scratch space; afterwards `last` is the tet where a line ends that leaves the mesh.
  struct Walk {
    std::vector<unsigned> seen{};
    unsigned stamp = 0;
    std::vector<Part> open{};
    int last = -1;
  };

  /// A vertex, or two at the ends of an edge, where a line must end; -1: anywhere at the point. Of
  /// several in one place, on the sides of a cut, only one may be in sight.
  struct Aim {
    int a = -1, b = -1;
  };

  bool sees(int vertex, const Vec3& to, Walk& walk, Aim aim = {-1, -1}) const;
  /// From a point on the edge between two vertices.
  bool sees(int a, int b, const Vec3& from, const Vec3& to, Walk& walk, Aim aim = {-1, -1}) const;

  std::span<const int> tets_at(int vertex) const;  // of some volume
  /// The tets that have a face; itself among them.
  std::span<const int> tets_of_face(int tet, int k) const;

 private:
  bool clip(int tet, const Vec3& from, const Vec3& to, Part& part) const;
  void start(Walk& walk) const;
  bool walk_on(const Vec3& from, const Vec3& to, Walk& walk, Aim aim) const;
  bool holds(int tet, Aim aim) const;

  const TetMesh& mesh_;
  const Rows<int, 4>& tet_faces_;
  const Gradients& gradients_;
  std::vector<int> at_vertex_begin_, at_vertex_, of_face_begin_, of_face_;
};

/// How many pairs of tets that share a face alone lie on the same side of it, one folded over the
/// other: what is within the mesh is not clear there.
int folded_tets(const TetMesh& mesh, const TetSight& sight);

/// How sharply the mesh turns about the edges of its boundary: vertex -> the other ends of edges
/// with more than half a turn of tets round them, where shortest ways may bend.
std::vector<std::vector<int>> reentrant_edges(const TetMesh& mesh, const TetSight& sight);

}  // namespace littoral
