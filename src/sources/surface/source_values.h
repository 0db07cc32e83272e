#pragma once
// Values at sources that distance is counted from.

#include <string>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/task.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/report.h"
#include "littoral/sources.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

/// The range of the values of all curves and points.
struct ValueRange {
  double low = 0, high = 0;
  bool same() const { return low == high; }
};
ValueRange value_range(const Sources& sources);
/// That of curves with sides.
ValueRange signed_value_range(const Sources& sources);

/// The same sources with `shift` added to every value.
Sources shifted_values(const Sources& sources, double shift);

/// Shortest paths along edges from vertices that are counted from values.
class EdgePaths {
 public:
  struct Edge {
    int a, b;
    double length;
  };
  struct Start {
    int vertex;
    double value;
  };
  EdgePaths(int n_vertices, const std::vector<Edge>& edges);
  explicit EdgePaths(const IntrinsicTriangulation& T);  // sides of its triangles [units]

  /// At the vertices, +inf where none leads and beyond `limit`.
  VecX lengths(const std::vector<Start>& from, double limit = infinity,
               const Task& task = Task()) const;

 private:
  std::vector<int> first_;  // by vertex, in neighbours_
  std::vector<std::pair<int, double>> neighbours_;
};

/// The least of c_i + d_i at the vertices [units], d_i being the length of a path along edges: no
/// less than the distance.
VecX reach_along_edges(const IntrinsicTriangulation& T, const TriangleSources& sources);

/// Warns of points and of the first `n_curves` curves with values that others reach sooner:
/// c_i > c_j + d(i, j). `reach` (vertices) [units] is no less than the least of c_j + d_j, so that
/// whatever is warned of is so.
void warn_of_shadowed(const IntrinsicTriangulation& T, const TriangleSources& sources,
                      const PlacedSources& placed, int n_curves, const VecX& reach, Report& report);

/// Says so of sources by name, each with what it is above the others [length].
void warn_of_shadowed(const std::vector<std::pair<std::string, double>>& excess, Report& report);

/// The same by paths along edges; does nothing where all values are the same.
void warn_of_shadowed(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                      const PlacedSources& placed, Report& report);

}  // namespace littoral
