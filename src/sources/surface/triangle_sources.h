#pragma once
// Sources as points and straight segments inside triangles: for methods that walk over the mesh.

#include <array>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "operators/triangles.h"
#include "sources/surface/pieces.h"

namespace littoral {

/// Everything distance is measured from, triangle by triangle. Sources are numbered: the pieces of
/// PlacedSources in their order, then its points. The end of pieces counts as the first of them.
struct TriangleSources {
  struct Segment {
    int triangle;
    std::array<double, 3> a{}, b{};  // start and end, per corner
    bool is_signed = true;           // positive to the left of travel
    int source = -1;                 // number of the piece
  };
  /// Points, each once: a vertex, or one entry for every triangle that contains the point.
  struct Points {
    std::vector<int> vertices;
    std::vector<PointInFace> inside;
    std::vector<int> vertex_source, inside_source;  // number of each entry; of several at one
                                                    // place one of least value
  };
  std::vector<Segment> segments;  // along an edge: once for every triangle there
  Points nodes;                   // ends of segments
  Points isolated;
  std::vector<char> reached;  // components that hold a source
  std::vector<double> value;  // by number [units]; empty: all 0

  double value_of(int source) const { return source < 0 || value.empty() ? 0 : value[source]; }
};

/// Throws InputError if no source lies on a face with three different vertices.
TriangleSources triangle_sources(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                 const PlacedSources& sources);

/// Triangles around a point in its simplest form, with its barycentrics in each; `without` lists
/// triangles to leave out.
std::vector<PointInFace> triangles_around(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                          const SurfacePoint& p,
                                          const std::vector<int>& without = {});

/// The piece in every triangle that contains it, not only in its own face.
std::vector<TriangleSources::Segment> segments_of(const SurfaceMesh& mesh,
                                                  const IntrinsicTriangulation& T,
                                                  const CurvePiece& piece);

}  // namespace littoral
