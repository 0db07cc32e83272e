#pragma once
// Distance between many pairs of points of one surface: all at once, or one solve for each source.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/surface/surface_domain.h"
#include "methods/regularized/all_pairs.h"

namespace littoral {

/// Triangle meshes as the domain of methods that find all distances at once. Sources are the
/// vertices whose rows are wanted, answers have a row for each of them [length].
struct PairsDomain {
  using Sources = std::vector<int>;
  using Answer = MatX;
  static constexpr const char* title = "Pairs of vertices";

  std::shared_ptr<const SurfaceMesh> mesh;

  std::string kind() const;
};

template <>
std::vector<Method<PairsDomain>> library_methods();

/// The methods of both kinds: those of distance on surfaces, whose default is the default here,
/// then those for all pairs.
std::vector<MethodInfo> pair_methods();

/// Throws InputError if there is no such method, it lacks an option, or a value is out of range.
void check_pairs_method(const AnyMethod& method);

struct PairsAnswer {
  MatX distances;                            // sources x vertices [length], +inf between components
  std::optional<PairStatistics> statistics;  // if all vertices of a mesh are sources
};

/// Row i holds the distances from source i to all vertices. Methods for all pairs solve once,
/// whichever rows are wanted; methods of distance solve for every source, on factors that they
/// share, side by side and, where they can, several at once (solve_many).
///
/// No vertices: all. Throws InputError for bad input, UnsupportedError where the method does not
/// run, IoError with the estimate where the matrix does not fit into memory, Cancelled.
PairsAnswer pair_distances(const SurfaceDomain& domain, const std::vector<int>& vertices,
                           const AnyMethod& method, Task task, Report& report);

/// What is kept of the values at the vertices: `size` numbers; all of them where there is no `of`.
struct KeptOfRow {
  Eigen::Index size = 0;
  std::function<VecX(const VecX& values)> of{};
};

/// Row i holds the distances at the vertices from points[i], or what is kept of them, as solve_many
/// finds them; 0 at the vertex that a point is. Rows of points that belong to no face
/// are +inf.
MatX distance_rows(const Solver<SurfaceDomain>& solver, const SurfaceDomain& domain,
                   const std::vector<SurfacePoint>& points, Task task, Report& report,
                   const KeptOfRow& kept = {});

}  // namespace littoral
