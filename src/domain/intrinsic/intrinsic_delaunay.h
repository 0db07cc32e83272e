#pragma once
// Better triangles on the same surface: intrinsic Delaunay flips and refinement, with whatever is
// drawn on the surface kept in place.

#include <vector>

#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/report.h"

namespace littoral {

/// Points on a triangulation and straight segments between them, each inside one face or along one
/// edge.
struct CurveNetwork {
  struct Segment {
    int id = 0;                // of the segment it is a part of
    double from = 0, to = 1;   // part of that
    int a = 0, b = 0;          // end points, into `nodes`
    int face = -1, edge = -1;  // that it lies in, or along
    bool mirrored = false;     // along an edge whose first face now calls left what was right
  };
  std::vector<SurfacePoint> nodes;
  std::vector<Segment> segments;
};

/// Share of all edges between two triangles that are not Delaunay: the angles across from them are
/// more than half a turn together, and their weights in the cotan Laplacian negative.
double share_not_delaunay(const IntrinsicTriangulation& T);

struct RefineOptions {
  double smallest_angle = 25;  // degrees; 0: flips only
  double growth = 3;           // at most this many vertices are added for each there was
  std::vector<char> keep;      // edges of the input that are never flipped; empty: none
};

/// A triangulation of the same surface. Its first vertices are those of the input; `mesh` has its
/// connectivity, with added vertices placed in space for pictures only.
struct Retriangulation {
  SurfaceMesh mesh;
  IntrinsicTriangulation T;
  CurveNetwork curves;
  int flips = 0, added = 0;  // operations
  int not_delaunay = 0;      // edges left with a negative weight in the cotan Laplacian
};

/// Flips edges until the triangulation is intrinsically Delaunay (Bobenko and Springborn 2007), and
/// splits the edges that end the longest-edge paths of triangles with a small angle, flipping again
/// (Rivara, "New longest-edge algorithms", 1997), until there are none or a bound is reached.
///
/// Edges of one or of more than two faces are never flipped; refinement splits them where they are
/// not Delaunay. Several edges of the result may join two vertices, but no face has a vertex twice.
/// Segments are cut where new edges cross them, in the plane of the two triangles of each flip, so
/// nothing is traced and nothing moves. At most 50 flips an edge.
Retriangulation intrinsic_delaunay(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                   CurveNetwork curves, const RefineOptions& options,
                                   Report& report, const Task& task);

}  // namespace littoral
