#pragma once
// Distance between all pairs of vertices in one call.

#include <optional>
#include <string>
#include <vector>

#include "api/registry.h"
#include "api/surface/surface_method.h"
#include "base/report.h"
#include "base/task.h"
#include "domain/mesh/surface_mesh.h"
#include "methods/regularized/all_pairs.h"

namespace littoral {

/// What to compute, in words.
struct PairsRequest {
  std::string method = "symmetric";  // or any method of distance from points
  OptionTexts options;               // name, value as text; others default
  std::vector<int> vertices;         // to measure from; empty: all
};

struct PairsAnswer {
  MatX distances;                            // sources x vertices [length], +inf between components
  std::optional<PairStatistics> statistics;  // if all vertices are sources
};

/// Symmetric all-pairs distance, and the methods of distance on surfaces.
const std::vector<MethodInfo>& pair_methods();

/// Throws InputError if there is no such method, it lacks an option, or a value is out of range.
void check_request(const PairsRequest& request);

/// Row i holds the distances from source i. "symmetric" solves for all pairs at once, component by
/// component (Alg. 2), whichever rows are wanted; other methods solve once for every source, side
/// by side, on factorizations made once. The report gets the statistics as residuals. Throws
/// InputError, UnsupportedError, SolveError, Cancelled, and IoError, before anything is computed,
/// if the matrices do not fit into memory.
PairsAnswer pair_distances(const SurfaceMesh& mesh, const PairsRequest& request, Task task,
                           Report& report);

}  // namespace littoral
